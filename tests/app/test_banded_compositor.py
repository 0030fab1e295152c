"""What changed is drawn, and nothing between parts that changed far from each other."""

from __future__ import annotations

import pytest
from textual.geometry import Region

from desire_tui.desktop.banded_compositor import GAP_ROWS, BandedCompositor, bands
from tests.app.conftest import desktop


def test_parts_near_each_other_are_drawn_as_one():
    top, near = Region(0, 2, 5, 3), Region(70, 5 + GAP_ROWS - 1, 5, 1)
    far, beside = Region(3, 30, 9, 1), Region(90, 28, 9, 4)
    assert bands([far, near, top, beside]) == [[top, near], [beside, far]]
    assert bands([Region(0, 0, 9, 9), Region(0, 1, 9, 1), Region(0, 8, 9, 1)]) != []
    assert len(bands([Region(0, 0, 9, 20), Region(0, 1, 9, 1), Region(0, 20, 9, 1)])) == 1


@pytest.mark.parametrize("gap", [0, 5, 30])
async def test_a_letter_and_the_cursors_place_are_drawn_without_the_lines_between(gap, program, monkeypatch):
    async with desktop(program("-- a line\n" * 60), size=(100, 40)) as desk:
        area = desk.app.editor.front
        await desk.press("alt+e")
        area.go_to(3 + gap, 0)
        await desk.idle()
        await desk.pilot.pause()  # the text has scrolled, and is drawn
        crops: list[Region] = []
        render = BandedCompositor._render_chops

        def seen(self, crop, is_rendered_line):
            crops.append(crop)
            return render(self, crop, is_rendered_line)

        monkeypatch.setattr(BandedCompositor, "_render_chops", seen)
        await desk.press("x")
        await desk.until(lambda: any(crop.height == 1 for crop in crops))
        assert max(crop.height for crop in crops) < 4
        shown = desk.app.screen._compositor.render_strips()
        assert any(strip.text.count("x-- a line") for strip in shown)
