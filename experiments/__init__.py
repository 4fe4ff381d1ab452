"""One file per question: a study and its chart."""
