"""What the papers' experiments share: scenes, how records are kept and drawn, and pictures of what lies between the stages."""
