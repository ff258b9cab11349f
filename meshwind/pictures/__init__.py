"""Pictures of a winding, drawn off the screen."""
