// Starts `desire lsp` and hands it what happens in the editor; all else is the server's work.
"use strict";

const { commands, window, workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

async function start() {
  const [command, ...args] = workspace.getConfiguration("desire").get("command");
  client = new LanguageClient("desire", "Desire", { command, args }, { documentSelector: [{ language: "desire" }] });
  try {
    await client.start();
  } catch (reason) {
    window.showErrorMessage(
      `'${command}' does not start (${reason.message}): pip install 'desire-tui[lsp]', or set "desire.command".`
    );
  }
}

async function activate(context) {
  context.subscriptions.push(
    commands.registerCommand("desire.runFile", () => {
      const editor = window.activeTextEditor;
      if (editor) {
        // registered by the client, because the server names it among its commands
        return commands.executeCommand("desire.run", editor.document.uri.toString());
      }
    }),
    commands.registerCommand("desire.restart", async () => {
      await client?.stop().catch(() => {});
      await start();
    })
  );
  await start();
}

function deactivate() {
  return client?.stop();
}

module.exports = { activate, deactivate };
