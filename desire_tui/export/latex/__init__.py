"""A program's equations as LaTeX, for a paper: AMS mathematics that LaTeX and KaTeX both know."""
