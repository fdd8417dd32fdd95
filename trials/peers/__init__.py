"""What the product is compared with: its own fits without its judgement, and two generic ways to shrink a gap, on the same cases."""
