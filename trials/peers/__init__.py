"""What the product is compared with: two generic ways to shrink a gap, on the same cases."""
