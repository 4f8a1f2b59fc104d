"""What hypothesis draws in place of every single place and value."""

from hypothesis import strategies as st

# Bytes, because of numbers hypothesis prefers the small ones, and would draw the same again.
seeds = st.binary(min_size=8, max_size=8)
