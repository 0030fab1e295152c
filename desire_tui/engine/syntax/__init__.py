"""From text to nodes: tokenizer, grammar, parser.

`parse` a program, `parse_command` a command line; `highlight` a line for an editor.
"""
