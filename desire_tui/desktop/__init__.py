"""Desktop."""
