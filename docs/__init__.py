"""The documentation's generator (`python -m docs.generate`); the pages themselves are Markdown."""
