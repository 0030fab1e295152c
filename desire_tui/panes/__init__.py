"""The panes beside the editor: command line, graph, quantities, problems, help, status."""
