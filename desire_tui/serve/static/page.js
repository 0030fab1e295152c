"use strict";
document.getElementById("again").addEventListener("click", () => window.location.reload());
// the terminal takes keys at once; its field is made when everything has been loaded
window.addEventListener("load", () => setTimeout(() => document.querySelector(".xterm-helper-textarea")?.focus()));

// what the desktop tells the page, beside what it draws
let unsaved = false;

function told(message) {
  if (typeof message.data !== "string") return;
  const [kind, content] = JSON.parse(message.data);
  if (kind === "unsaved") unsaved = content;
  if (kind === "file") keep(content.name, content.base64);
}

function keep(name, base64) {
  const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

window.WebSocket = class extends WebSocket {
  constructor(...words) {
    super(...words);
    this.addEventListener("message", told);
    this.addEventListener("close", () => { unsaved = false; }); // the work is kept where the desktop ran
  }
  send(data) { // the terminal tells its size before there is anybody to tell, and again afterwards
    if (this.readyState !== WebSocket.CONNECTING) super.send(data);
  }
};

window.addEventListener("beforeunload", (event) => {
  if (!unsaved) return;
  event.preventDefault();
  event.returnValue = ""; // older browsers ask only then
});
