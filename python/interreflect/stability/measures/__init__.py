"""What failures measure. Each function takes a Trial (and settings) and gives a Reading."""
