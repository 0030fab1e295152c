"""Source text to nodes: the only home of lark."""
