"""`desire lsp`: the language server, for other people's editors (Language Server Protocol 3.17, by pygls)."""
