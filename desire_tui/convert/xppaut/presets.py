"""`set` lines as presets; how an `.ode` file is run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.expressions import functions_in, number
from desire_tui.convert.model import Preset, Quantity
from desire_tui.convert.xppaut.declarations import braced, pairs
from desire_tui.convert.xppaut.options import preset_setting

if TYPE_CHECKING:
    from desire_tui.convert.xppaut.building import Building
    from desire_tui.convert.xppaut.logical_lines import Line


def presets(building: Building) -> None:
    """Add a preset for each `set` line."""
    for one in building.of("set"):
        name = f"set_{one.right.partition('{')[0].strip()}"
        values: list[Quantity] = []
        idle: list[str] = []
        for inner in braced(one.right):
            for key, text in pairs(inner) or ():
                found = _value(key, text, building, one.line)
                if found is None:
                    idle.append(f"{key}={text}")
                else:
                    values.append(found)
        if idle:
            building.note(one.line, ", ".join(idle), "no meaning here")
        if values:
            taken = {preset.name for preset in building.model.presets}
            while name in taken:
                name = f"{name}_again"
            building.model.presets.append(Preset(name, values, one.line.comment))


def _value(key: str, text: str, building: Building, line: Line) -> Quantity | None:
    """Return a parameter's or a system variable's value; None: an option without a meaning here."""
    if key.lower() in building.spelling:
        return Quantity(building.spelling[key.lower()], building.formula(text or "0", line))
    try:
        setting = preset_setting(key, float(text))
    except ValueError:
        return None
    return None if setting is None else Quantity(setting[0], number(setting[1]))


def read_options(building: Building) -> None:
    """Read the `@` lines."""
    for one in building.of("option"):
        idle: list[str] = []
        for name, value in pairs(one.right.replace("{", " ").replace("}", " ")) or [(one.right, "")]:
            reason = building.options.read(name, value)
            if reason == "":
                idle.append(name)
            elif reason is not None:
                building.note(one.line, f"{name}={value}", reason)
        if idle:
            building.note(one.line, ", ".join(idle), "no meaning here")


def settings(building: Building) -> None:
    """Fill in the model's settings."""
    model = building.model
    discrete = building.options.is_map or bool(building.of("next") and not building.of("rate"))
    formulas = [state.rate for state in model.states] + [one.value for one in model.variables]
    drawn = any({"ran", "gauss"} & functions_in(one) for one in formulas)
    for one in building.of("wiener"):
        if discrete or not model.states:
            building.refuse(one.line, "white noise needs a differential equation")
    noisy = drawn or bool(model.noises or model.markov)
    building.options.settings(model.settings, discrete=discrete, noisy=noisy)
