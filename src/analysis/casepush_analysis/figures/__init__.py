"""Pictures of a recording. Each module draws one figure; none keeps state or shows a window."""
