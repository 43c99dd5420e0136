"""Elementary functions to any number of digits, by decimal arithmetic alone.

decimal's exp, ln, sqrt and division round correctly at the context's precision. The other functions are sums of
Taylor series with guard digits. Arguments are Decimals, results are Decimals with about `getcontext().prec` digits.
"""

from decimal import Decimal, getcontext, localcontext


def _series(first, ratio):
    """Sums first * ratio(1) * ... * ratio(n) over n >= 0, until a term no longer matters."""
    total = term = first
    n = 0
    while term and term.adjusted() > total.adjusted() - getcontext().prec - 2:
        n += 1
        term *= ratio(n)
        total += term
    return total


def atan_inverse(n):
    """atan(1 / n) for an integer n > 1."""
    total, power, k = Decimal(0), Decimal(1) / n, 0
    while power.adjusted() > -getcontext().prec - 2:
        total += power / (2 * k + 1) * (-1) ** k
        power /= n * n
        k += 1
    return total


def pi():
    """pi, by Machin's formula."""
    with localcontext() as context:
        context.prec += 10
        value = 4 * (4 * atan_inverse(5) - atan_inverse(239))
    return +value


def _sin_cos(x, shift):
    """sin(x + shift * pi / 2)."""
    with localcontext() as context:
        context.prec += max(0, x.adjusted()) + 20
        half = pi() / 2
        n = (x / half).to_integral_value()
        r = x - n * half
        quarter = (int(n) + shift) % 4
        if quarter % 2:
            value = _series(Decimal(1), lambda k: -r * r / ((2 * k - 1) * (2 * k)))
        else:
            value = _series(r, lambda k: -r * r / ((2 * k) * (2 * k + 1)))
        value = -value if quarter >= 2 else value
    return +value


def sin(x):
    return _sin_cos(x, 0)


def cos(x):
    return _sin_cos(x, 1)


def tan(x):
    with localcontext() as context:
        context.prec += 10
        value = sin(x) / cos(x)
    return +value


def atan(x):
    """atan(x): the argument is halved until the series converges fast."""
    with localcontext() as context:
        context.prec += 20
        halvings = 0
        while abs(x) > Decimal("0.05"):
            x = x / (1 + (1 + x * x).sqrt())
            halvings += 1
        total, power, k = Decimal(0), x, 0
        while power and power.adjusted() > x.adjusted() - context.prec - 2:
            total += power / (2 * k + 1) * (-1) ** k
            power *= x * x
            k += 1
        total *= 2**halvings
    return +total


def atan2(y, x):
    with localcontext() as context:
        context.prec += 10
        if abs(y) <= abs(x):
            value = atan(y / x) + (0 if x > 0 else pi().copy_sign(y))
        else:
            value = (pi() / 2).copy_sign(y) - atan(x / y)
    return +value


def asin(x):
    with localcontext() as context:
        context.prec += 10
        value = atan2(x, ((1 - x) * (1 + x)).sqrt())
    return +value


def acos(x):
    with localcontext() as context:
        context.prec += 10
        value = atan2(((1 - x) * (1 + x)).sqrt(), x)
    return +value


def hypot(x, y):
    with localcontext() as context:
        context.prec += 10
        value = (x * x + y * y).sqrt()
    return +value


def exp(x):
    return x.exp()


def log(x):
    return x.ln()


def power(x, y):
    """x^y for x > 0."""
    with localcontext() as context:
        context.prec += 30
        value = (x.ln() * y).exp()
    return +value


def exp2(x):
    return power(Decimal(2), x)


def log2(x):
    with localcontext() as context:
        context.prec += 10
        value = x.ln() / Decimal(2).ln()
    return +value


def log10(x):
    return x.log10()


def cbrt(x):
    return power(abs(x), Decimal(1) / 3).copy_sign(x)


def expm1(x):
    with localcontext() as context:
        context.prec += 10 + max(0, -x.adjusted())
        value = x.exp() - 1
    return +value


def log1p(x):
    with localcontext() as context:
        context.prec += 10 + max(0, -x.adjusted())
        value = (1 + x).ln()
    return +value


def erf(x):
    """erf(x), by the series of positive terms 2 x / sqrt(pi) exp(-x^2) sum (2 x^2)^n / (1 3 5 ... (2 n + 1))."""
    with localcontext() as context:
        context.prec += 10
        total = _series(x, lambda n: 2 * x * x / (2 * n + 1))
        value = 2 / pi().sqrt() * (-x * x).exp() * total
    return +value


def erfc(x):
    with localcontext() as context:
        context.prec += 10 + (int(x * x / 2) + 3 if x > 0 else 0)
        value = 1 - erf(x)
    return +value
