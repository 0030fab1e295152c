"""The Python interface: `desire_tui.load`, `desire_tui.run` and what they return."""
