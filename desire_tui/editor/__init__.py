"""The editor: tabs with programs, their colours and marks, search, recovery. Knows no other pane."""
