"""The other panes of the desktop."""
