"""Native models with events under rules 0 … 8: their steps are `runtime.moments`, compiled."""
