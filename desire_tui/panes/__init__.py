"""The panes beside the editor, which they do not know: command line, graph, quantities, help, status …."""
