"""The server: which request of the protocol is answered by what."""

from __future__ import annotations

import asyncio
import logging
import os
import sys
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer

from desire_tui.engine.session.static_check import StaticChecker
from desire_tui.language.live_check import LiveChecker
from desire_tui.lsp import layout, navigation, running, semantic_tokens, words
from desire_tui.lsp.problems import diagnostics_of, fixes_of
from desire_tui.lsp.protocol import DocumentProtocol
from desire_tui.version import __version__

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.lsp.documents import Document, Snapshot

    Answer = TypeVar("Answer")

SECONDS_MOST = 30.0
"""A check of one text may take so much of the processor's time; then it says how far it came."""
_logger = logging.getLogger(__name__)


class DesireServer(LanguageServer):
    """A language server for one client.

    Its documents are changed in the event loop, which never waits: what looks at a whole program does so in a
    thread, on a snapshot.
    """

    protocol: DocumentProtocol

    def __init__(self) -> None:
        super().__init__("desire", __version__, protocol_cls=DocumentProtocol)
        checker = StaticChecker()
        self.checker = LiveChecker(
            partial(checker.check, quick=True, seconds=SECONDS_MOST), self._checked, self._check_failed,
            partial(checker.check, quick=False, seconds=SECONDS_MOST),
        )  # fmt: skip
        self.runs = running.Runs()
        self._loop: asyncio.AbstractEventLoop | None = None
        _register(self)

    @property
    def documents(self) -> dict[str, Document]:
        """What the client has open, by address."""
        return self.protocol.documents

    async def ask(self, uri: str, question: Callable[[Snapshot], Answer]) -> Answer | None:
        """Answer a question about a document as it is now, in a thread; None: it is not open."""
        document = self.documents.get(uri)
        if document is None:
            return None
        snapshot = document.snapshot
        return await asyncio.get_running_loop().run_in_executor(self.thread_pool, question, snapshot)

    def check(self, uri: str) -> None:
        """Look for a document's problems, which are told when they are found."""
        document = self.documents.get(uri)
        if document is not None:
            self._loop = asyncio.get_running_loop()
            self.checker.ask(document, document.revision, document.snapshot.source.text)

    def _checked(self, number: int, revision: int, problems: tuple[Diagnostic, ...]) -> None:
        """Take what the checking thread found to the event loop."""
        assert self._loop is not None
        self._loop.call_soon_threadsafe(self._publish, number, revision, problems)

    def _check_failed(self, fault: BaseException) -> None:
        _logger.error("a check failed", exc_info=fault)

    def _publish(self, number: int, revision: int, problems: tuple[Diagnostic, ...]) -> None:
        document = next((one for one in self.documents.values() if one.number == number), None)
        if document is None or document.revision != revision:
            return  # closed, or edited meanwhile
        found = diagnostics_of(problems, document.uri, document.snapshot)
        self.text_document_publish_diagnostics(
            types.PublishDiagnosticsParams(document.uri, found, version=document.version)
        )

    async def run(self, uri: str) -> dict[str, Any] | None:
        """Run a document's program and tell what became of it; None: it is not open."""
        document = self.documents.get(uri)
        if document is None:
            self.window_show_message(types.ShowMessageParams(types.MessageType.Error, f"{uri} is not open"))
            return None
        answer = await self.runs.run(document)
        document.know(answer["values"])
        if answer["console"]:
            self.window_log_message(types.LogMessageParams(types.MessageType.Log, answer["console"]))
        self.window_show_message(types.ShowMessageParams(*running.report(document.name, answer)))
        window = self.client_capabilities.window
        if answer["pictures"] and window is not None and window.show_document is not None:
            shown = types.ShowDocumentParams(
                uri=Path(answer["pictures"][-1]).as_uri(), external=False, take_focus=False
            )
            with suppress(JsonRpcException):  # Neovim 0.7 says that it can, and cannot
                await self.window_show_document_async(shown)
        return answer


def _register(server: DesireServer) -> None:
    """Name what answers each request."""
    feature = server.feature

    @feature(types.TEXT_DOCUMENT_DID_OPEN)
    def _(params: types.DidOpenTextDocumentParams) -> None:
        server.check(params.text_document.uri)

    @feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def _(params: types.DidChangeTextDocumentParams) -> None:
        server.check(params.text_document.uri)

    @feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def _(params: types.DidCloseTextDocumentParams) -> None:
        server.text_document_publish_diagnostics(types.PublishDiagnosticsParams(params.text_document.uri, []))

    @feature(types.TEXT_DOCUMENT_CODE_ACTION, types.CodeActionOptions([types.CodeActionKind.QuickFix]))
    def _(params: types.CodeActionParams) -> list[types.CodeAction]:
        return fixes_of(params.context.diagnostics, params.text_document.uri)

    _register_words(server)
    _register_names(server)
    _register_layout(server)


def _register_words(server: DesireServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(["/"], resolve_provider=True))
    async def _(params: types.CompletionParams) -> types.CompletionList | None:
        return await server.ask(
            params.text_document.uri, partial(words.completions, position=params.position)
        )

    @server.feature(types.COMPLETION_ITEM_RESOLVE)
    def _(item: types.CompletionItem) -> types.CompletionItem:
        return words.explained(item)

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    async def _(params: types.HoverParams) -> types.Hover | None:
        return await server.ask(params.text_document.uri, partial(words.hover, position=params.position))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, semantic_tokens.LEGEND)
    async def _(params: types.SemanticTokensParams) -> types.SemanticTokens | None:
        data = await server.ask(params.text_document.uri, semantic_tokens.semantic_tokens)
        return None if data is None else types.SemanticTokens(data)

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE, semantic_tokens.LEGEND)
    async def _(params: types.SemanticTokensRangeParams) -> types.SemanticTokens | None:
        rows = (params.range.start.line, params.range.end.line)
        tokens = partial(semantic_tokens.semantic_tokens, first=rows[0], last=rows[1])
        data = await server.ask(params.text_document.uri, tokens)
        return None if data is None else types.SemanticTokens(data)


def _register_names(server: DesireServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    async def _(params: types.DefinitionParams) -> types.Location | None:
        uri = params.text_document.uri
        return await server.ask(uri, partial(navigation.definition, uri=uri, position=params.position))

    @server.feature(types.TEXT_DOCUMENT_DECLARATION)
    async def _(params: types.DeclarationParams) -> types.Location | None:
        uri = params.text_document.uri
        return await server.ask(uri, partial(navigation.declaration, uri=uri, position=params.position))

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    async def _(params: types.ReferenceParams) -> list[types.Location] | None:
        uri, declared = params.text_document.uri, params.context.include_declaration
        question = partial(
            navigation.references, uri=uri, position=params.position, with_declaration=declared
        )
        return await server.ask(uri, question)

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    async def _(params: types.DocumentHighlightParams) -> list[types.DocumentHighlight] | None:
        question = partial(navigation.highlights, position=params.position)
        return await server.ask(params.text_document.uri, question)

    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    async def _(params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder | None:
        question = partial(navigation.renamable, position=params.position)
        return await server.ask(params.text_document.uri, question)

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    async def _(params: types.RenameParams) -> types.WorkspaceEdit | None:
        uri = params.text_document.uri
        question = partial(navigation.rename, uri=uri, position=params.position, new=params.new_name)
        return await server.ask(uri, question)


def _register_layout(server: DesireServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    async def _(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol] | None:
        return await server.ask(params.text_document.uri, layout.symbols)

    @server.feature(types.TEXT_DOCUMENT_FOLDING_RANGE)
    async def _(params: types.FoldingRangeParams) -> list[types.FoldingRange] | None:
        return await server.ask(params.text_document.uri, layout.folding)

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    async def _(params: types.DocumentFormattingParams) -> list[types.TextEdit] | None:
        return await server.ask(params.text_document.uri, layout.formatting)

    @server.feature(types.TEXT_DOCUMENT_RANGE_FORMATTING)
    async def _(params: types.DocumentRangeFormattingParams) -> list[types.TextEdit] | None:
        return await server.ask(params.text_document.uri, partial(layout.formatting, rows=params.range))

    @server.feature(types.TEXT_DOCUMENT_CODE_LENS)
    async def _(params: types.CodeLensParams) -> list[types.CodeLens] | None:
        uri = params.text_document.uri
        return await server.ask(uri, partial(running.lenses, uri=uri))

    @server.command(running.RUN)
    async def _(uri: str) -> dict[str, Any] | None:
        return await server.run(uri)


def serve() -> None:
    """Answer a client on standard input and output until it leaves."""
    server = DesireServer()
    ours = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what anything prints is no message of the protocol
    try:
        server.start_io(sys.stdin.buffer, ours)
    finally:
        server.runs.close()
