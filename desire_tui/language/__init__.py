"""Answers about a program's text for those who edit it: the desktop's editor and other people's (`lsp`).

Text in, places and sentences out; nothing here knows a screen or a protocol.
"""
