"""Pages and pictures made from descriptions: of every technique, stage and method. Nothing of them is kept by hand."""
