"""A language client that does what a script says: a real server process, JSON-RPC over its pipes."""

from __future__ import annotations

import json
import queue
import subprocess
import sys
import threading
from contextlib import contextmanager

PATIENCE = 120.0


class Client:
    """Sends requests and waits for their answers; notifications of the server are kept by method."""

    def __init__(self, process):
        self._process = process
        self._number = 0
        self._answers: queue.Queue = queue.Queue()
        self.heard: dict[str, queue.Queue] = {}
        self._lock = threading.Lock()
        self.capabilities = {}
        self.agreement = {"result": {"success": True}}
        """The answer to what the server asks."""
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self):
        pipe = self._process.stdout
        while header := pipe.readline():
            length = int(header.split(b":")[1])
            while pipe.readline().strip():
                pass
            message = json.loads(pipe.read(length))
            if "method" not in message:
                self._answers.put(message)
                continue
            self._of(message["method"]).put(message["params"])
            if "id" in message:
                self._send({"id": message["id"], **self.agreement})
        self._answers.put({"id": None, "error": "the server has ended"})

    def _of(self, method):
        with self._lock:
            return self.heard.setdefault(method, queue.Queue())

    def _send(self, message):
        data = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self._process.stdin.write(b"Content-Length: %d\r\n\r\n%b" % (len(data), data))
        self._process.stdin.flush()

    def notify(self, method, **params):
        self._send({"method": method, "params": params})

    def ask(self, method, **params):
        """Return the whole answer, an error too."""
        self._number += 1
        self._send({"id": self._number, "method": method, "params": params})
        answer = self._answers.get(timeout=PATIENCE)
        assert answer["id"] == self._number, answer
        return answer

    def request(self, method, **params):
        answer = self.ask(method, **params)
        assert "error" not in answer, answer["error"]
        return answer["result"]

    def told(self, method):
        """Return the next notification of a method."""
        return self._of(method).get(timeout=PATIENCE)

    # ------------------------------------------------------------------------------------------ documents

    def open(self, uri, text):
        document = {"uri": uri, "languageId": "desire", "version": 1, "text": text}
        self.notify("textDocument/didOpen", textDocument=document)

    def edit(self, uri, version, start, end, text):
        change = {"range": span(start, end), "text": text}
        self.notify(
            "textDocument/didChange", textDocument={"uri": uri, "version": version}, contentChanges=[change]
        )

    def at(self, method, uri, row, column, **more):
        place = {"line": row, "character": column}
        return self.request(f"textDocument/{method}", textDocument={"uri": uri}, position=place, **more)

    def problems(self, uri, version):
        """Return what is told of that version."""
        while True:
            told = self.told("textDocument/publishDiagnostics")
            if told["uri"] == uri and told.get("version") == version:
                return told["diagnostics"]


def span(start, end):
    return {
        "start": {"line": start[0], "character": start[1]},
        "end": {"line": end[0], "character": end[1]},
    }


@contextmanager
def client(encodings=None):
    """A client that has greeted its server, and takes its leave at the end."""
    process = subprocess.Popen(
        [sys.executable, "-m", "desire_tui", "lsp", "--stdio"], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    made = Client(process)
    try:
        general = {"positionEncodings": encodings} if encodings else {}
        capabilities = {"general": general, "window": {"showDocument": {"support": True}}}
        greeting = made.request("initialize", processId=None, rootUri=None, capabilities=capabilities)
        made.capabilities = greeting["capabilities"]
        made.notify("initialized")
        yield made
        made.request("shutdown")
        made.notify("exit")
        assert process.wait(PATIENCE) == 0
    finally:
        process.kill()
        process.wait()
        process.stdin.close()
        process.stdout.close()


def applied(text, edits):
    """Return a text after the edits of an answer; places count characters here."""
    starts = [0]
    for row in text.split("\n"):
        starts.append(starts[-1] + len(row) + 1)
    spans = sorted(
        (
            starts[edit["range"]["start"]["line"]] + edit["range"]["start"]["character"],
            starts[edit["range"]["end"]["line"]] + edit["range"]["end"]["character"],
            edit["newText"],
        )
        for edit in edits
    )
    for start, end, new in reversed(spans):
        text = text[:start] + new + text[end:]
    return text
