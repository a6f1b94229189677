"""Draw figures from datasets."""
