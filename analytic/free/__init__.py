"""Free motions, made by masses and forces without a driver; `release` works out the reference."""
