"""One Session: program, quantities, run, graph, console. The only package that knows every stage."""
