"""The notebook on the desktop: what goes wrong with it is told, and the session goes on."""

from __future__ import annotations

from .conftest import OSCILLATOR, desktop


async def test_a_notebook_is_written_and_its_loss_is_told(program, tmp_path):
    async with desktop(program(OSCILLATOR)) as desk:
        await desk.line("notebook 'n.md'")
        await desk.idle()
        await desk.press("f5")
        await desk.idle()
        notebook = tmp_path / "n.md"
        assert "Run 1: rule 3" in notebook.read_text()
        assert (tmp_path / "n-1.png").exists()
        notebook.unlink()
        notebook.mkdir()  # nobody can write to that
        await desk.line("write 2*21")
        await desk.idle()
        await desk.until(lambda: "42" in desk.output)
        await desk.until(lambda: "error 106" in desk.output)
        assert "Is a directory" in desk.output
        await desk.line("write 43")
        await desk.until(lambda: "43" in desk.output)
        assert desk.output.count("error 106") == 1
