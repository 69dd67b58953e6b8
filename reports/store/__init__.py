"""Storage of a sweep: a folder of Parquet files with a manifest."""
