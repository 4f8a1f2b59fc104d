"""What tests share: random robots, independent oracles, processes."""
