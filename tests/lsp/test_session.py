"""A session as an editor has it: a real server process is opened, asked, edited, run and left."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.lsp.client import applied, client, span

TEXT = """\
-- free oscillation
k = 25|r=1|x = 0.8 -- stiffness, damping, start
TMAX = 10 | DT = 0.01 | NN = 501
drun
DYNAMIC
d/dt x = xdot
d/dt xdot = -k*x - r*xdto
dispt x, xdot
"""
MENDED = TEXT.replace("xdto", "xdot")


@pytest.fixture(scope="module")
def session():
    with client() as made:
        yield made


def test_a_whole_session(session, tmp_path):
    uri = (tmp_path / "free.src").as_uri()  # never saved
    session.open(uri, TEXT)

    (problem,) = session.problems(uri, 1)
    assert (problem["code"], problem["severity"], problem["source"]) == (200, 1, "desire")
    assert problem["range"] == span((6, 21), (6, 25))
    assert "did you mean 'xdot'?" in problem["message"]

    (fix,) = session.request(
        "textDocument/codeAction",
        textDocument={"uri": uri}, range=problem["range"], context={"diagnostics": [problem]},
    )  # fmt: skip
    assert fix["title"] == "Change 'xdto' to 'xdot'"
    assert applied(TEXT, fix["edit"]["changes"][uri]) == MENDED
    session.edit(uri, 2, (6, 21), (6, 25), "xdot")
    assert session.problems(uri, 2) == []

    session.edit(uri, 3, (7, 0), (7, 0), "disp\n")
    offered = session.at("completion", uri, 7, 4)
    words = [item["label"] for item in offered["items"]]
    assert {"dispt", "dispxy", "DISPXY", "display"} <= set(words)
    item = next(item for item in offered["items"] if item["label"] == "dispt")
    assert "dispt y" in session.request("completionItem/resolve", **item)["documentation"]["value"]
    session.edit(uri, 4, (7, 0), (8, 0), "")

    told = session.at("hover", uri, 6, 13)["contents"]["value"]  # k
    assert "`k` · *parameter* · line 2" in told
    assert "value 25" in told
    assert "stiffness, damping, start" in told
    told = session.at("hover", uri, 7, 7)["contents"]["value"]
    assert "*state*" in told
    assert "d/dt x = xdot" in told
    assert "x = 0.8" in told
    assert "starts at 0.8" in told
    assert session.at("hover", uri, 3, 2)["contents"]["value"].startswith("# drun")

    place = session.at("definition", uri, 7, 9)
    assert place["range"] == span((6, 5), (6, 9))
    assert session.at("declaration", uri, 7, 6)["range"] == span((1, 11), (1, 12))
    found = session.at("references", uri, 5, 5, context={"includeDeclaration": True})
    assert [one["range"]["start"]["line"] for one in found] == [1, 5, 6, 7]

    ready = session.at("prepareRename", uri, 5, 5)
    assert ready["placeholder"] == "x"
    refused = session.ask(
        "textDocument/rename", textDocument={"uri": uri}, position={"line": 5, "character": 5}, newName="k"
    )
    assert refused["error"]["message"] == "'k' is taken: it is a variable in line 2"
    edits = session.at("rename", uri, 5, 5, newName="y")["changes"][uri]
    assert applied(MENDED, edits) == (
        MENDED.replace("x = 0.8", "y = 0.8").replace("d/dt x ", "d/dt y ").replace("*x ", "*y ").replace(
            "dispt x", "dispt y")
    )  # fmt: skip

    options = {"tabSize": 2, "insertSpaces": True}
    edits = session.request("textDocument/formatting", textDocument={"uri": uri}, options=options)
    assert applied(MENDED, edits) == MENDED.replace("k = 25|r=1|x", "k = 25 | r = 1 | x")

    (lens,) = session.request("textDocument/codeLens", textDocument={"uri": uri})
    assert lens["command"]["command"] == "desire.run"
    assert lens["range"]["start"]["line"] == 1
    answer = session.request(
        "workspace/executeCommand", command="desire.run", arguments=lens["command"]["arguments"]
    )
    assert answer["status"] == "done"
    assert answer["values"]["t"] == pytest.approx(10)
    picture = Path(answer["pictures"][0])
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert session.told("window/showDocument")["uri"] == picture.as_uri()
    said = session.told("window/showMessage")["message"]
    assert said.startswith("free.src: done, 1 run, graph in /")
    assert "after the last run" in session.at("hover", uri, 7, 7)["contents"]["value"]


def test_a_client_that_cannot_show_a_picture_after_all_has_its_answer(session):
    """Neovim 0.7 says that it shows documents, and answers that it does not know the method."""
    session.agreement = {"error": {"code": -32601, "message": "MethodNotFound"}}
    session.open("untitled:plot", MENDED)
    answer = session.request("workspace/executeCommand", command="desire.run", arguments=["untitled:plot"])
    session.agreement = {"result": {"success": True}}
    assert (answer["status"], len(answer["pictures"])) == ("done", 1)
    session.told("window/showMessage")


def test_a_program_that_fails_is_told_with_its_line(session, tmp_path):
    uri = (tmp_path / "bad.src").as_uri()
    session.open(uri, "write 'a'\nx = 1/0\n")
    answer = session.request("workspace/executeCommand", command="desire.run", arguments=[uri])
    assert (answer["status"], answer["console"]) == ("failed", "a\n")
    assert "line 2: error 5" in session.told("window/showMessage")["message"]
    assert session.told("window/logMessage")["message"] == "a\n"


def test_outline_folds_and_colours(session):
    uri = "untitled:Untitled-1"
    session.open(uri, MENDED)
    outline = session.request("textDocument/documentSymbol", textDocument={"uri": uri})
    assert [(one["name"], one["detail"]) for one in outline] == [
        ("k", "parameter"), ("r", "parameter"), ("DYNAMIC", "segment, 2 d/dt lines"),
    ]  # fmt: skip
    assert [child["name"] for child in outline[2]["children"]] == ["x", "xdot"]
    (fold,) = session.request("textDocument/foldingRange", textDocument={"uri": uri})
    assert (fold["startLine"], fold["endLine"]) == (4, 7)
    data = session.request("textDocument/semanticTokens/full", textDocument={"uri": uri})["data"]
    legend = session.capabilities["semanticTokensProvider"]["legend"]["tokenTypes"]
    first = [(data[i], data[i + 2], legend[data[i + 3]]) for i in range(0, 20, 5)]
    assert first == [(0, 19, "comment"), (1, 1, "variable"), (0, 1, "operator"), (0, 2, "number")]
    part = session.request("textDocument/semanticTokens/range", textDocument={"uri": uri},
                           range=span((3, 0), (3, 4)))  # fmt: skip
    assert part["data"] == [3, 0, 4, legend.index("keyword"), 0]


def test_columns_count_utf_16_units(session):
    uri = "untitled:Untitled-2"
    session.open(uri, "write '𝜔𝜔', omega | omega = 1 | wrte = 2 -- 𝜔\n")
    problems = session.problems(uri, 1)
    assert [problem["range"]["start"]["character"] for problem in problems] == []
    place = session.at("definition", uri, 0, 15)
    assert place["range"] == span((0, 22), (0, 27))  # 𝜔 is two units: two columns further than characters
    session.edit(uri, 2, (0, 7), (0, 11), "w")
    assert session.at("definition", uri, 0, 12)["range"] == span((0, 19), (0, 24))


def test_a_client_may_choose_utf_8():
    with client(["utf-8"]) as made:
        assert made.capabilities["positionEncoding"] == "utf-8"
        made.open("untitled:a", "write '𝜔', omega | omega = 1\n")
        assert made.at("definition", "untitled:a", 0, 16)["range"] == span((0, 22), (0, 27))
