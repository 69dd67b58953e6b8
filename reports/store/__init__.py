"""A sweep as it is kept: a folder of Parquet files with a manifest."""
