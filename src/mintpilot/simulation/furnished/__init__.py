"""Furnished rooms in many styles, with people in six postures: perception is measured on them, nothing is flown."""
