"""Function generation: an output that is a given function of the input, in some points or with the
least error over a range.

A function y = f(x) is turned into angles by two linear maps, x into the input and y into the output
(`task`). Freudenstein's equation finds the mechanisms that meet 3, 4 or 5 points of it (`fourbar`,
`slider_crank`), Remez' exchange moves the points until the error has equal ripples
(`equal_ripple`), and the reference gives its size (`structural_error`).
"""
