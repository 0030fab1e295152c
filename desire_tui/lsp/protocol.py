"""The protocol with documents of our own.

pygls' own take every character that `str.splitlines` knows for a row's end (U+2028, form feed …), which LSP
does not, so places behind one would be wrong; and each edit copies the whole text. Overriding the methods
that open, change and close documents is what pygls' `protocol_cls` is for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from lsprotocol import types
from pygls.protocol import LanguageServerProtocol, lsp_method

from desire_tui.lsp.documents import Document

if TYPE_CHECKING:
    from collections.abc import Iterator

    from pygls.lsp.server import LanguageServer


class DocumentProtocol(LanguageServerProtocol):
    """LSP, whose documents are ours. A change of a document that nobody opened is ignored."""

    def __init__(self, server: LanguageServer, converter: Any) -> None:
        super().__init__(server, converter)
        self.documents: dict[str, Document] = {}

    def encoding(self) -> str:
        """Return what the client counts columns in."""
        agreed = self.workspace.position_encoding
        return "utf-16" if agreed is None else str(getattr(agreed, "value", agreed))

    @lsp_method(types.TEXT_DOCUMENT_DID_OPEN)
    def lsp_text_document__did_open(self, params: types.DidOpenTextDocumentParams) -> Iterator[Any]:
        """Open a document."""
        opened = params.text_document
        self.documents[opened.uri] = Document(opened.uri, opened.text, self.encoding(), opened.version)
        yield from self._handled(types.TEXT_DOCUMENT_DID_OPEN, params)

    @lsp_method(types.TEXT_DOCUMENT_DID_CHANGE)
    def lsp_text_document__did_change(self, params: types.DidChangeTextDocumentParams) -> Iterator[Any]:
        """Change a document."""
        document = self.documents.get(params.text_document.uri)
        if document is not None:
            document.change(params.content_changes, params.text_document.version)
        yield from self._handled(types.TEXT_DOCUMENT_DID_CHANGE, params)

    @lsp_method(types.TEXT_DOCUMENT_DID_CLOSE)
    def lsp_text_document__did_close(self, params: types.DidCloseTextDocumentParams) -> Iterator[Any]:
        """Forget a document."""
        self.documents.pop(params.text_document.uri, None)
        yield from self._handled(types.TEXT_DOCUMENT_DID_CLOSE, params)

    def _handled(self, method: str, params: Any) -> Iterator[Any]:
        handler = self.fm.features.get(method)
        if handler is not None:
            yield handler, (params,), None
