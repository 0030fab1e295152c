"""From text to nodes: tokenizer, grammar, parser, and back again.

`parse` a program, `parse_command` a command line; `highlight` a line for an editor; `format_program` and
`format_statement` write nodes as text.
"""
