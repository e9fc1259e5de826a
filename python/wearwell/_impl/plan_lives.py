"""Tests that demonstrate a life, and accelerated tests: functions of wearwell.plan."""

from .plan import answer


def demonstrate(goal, *, confidence=0.9, failures=0, specimens=None, time=None, distribution="weibull", shape=None, sigma=None,
                truth=None, sudden_death=None):
    """Plan a test that demonstrates a life: specimens, time, failures allowed.

    Without ``specimens`` and ``time``: the number of specimens for tests as long as the life. With one of them the other
    is found, with both the confidence that is reached.

    Parameters
    ----------
    goal : str
        What to show: "B10 >= 1e6 cycles", or "reliability >= 90 % at 1e6 cycles".
    confidence : float or str
        Confidence that a test that passes shows.
    failures : int or str
        Failures with which the test still passes: a number, or several like "0 to 3".
    specimens : int, optional
        Number of specimens.
    time : str or pint quantity, optional
        Length of each test, "2e6 cycles".
    distribution : {"weibull", "lognormal", "loglogistic"}
        Distribution of lives.
    shape : float or str, optional
        Weibull shape: a number, its 90 % interval "1.5 to 3", or a prior like "lognormal, median = 2, log_sd = 0.2".
        Without it: success run, tests as long as the life to show.
    sigma : float or str, optional
        Of lognormal and loglogistic lives: scale of the natural logarithm of life, as ``shape``.
    truth : str or sequence of str, optional
        True lives at which to report the probability to pass, "B10 = 3e6 cycles".
    sudden_death : int, optional
        Number of groups of equal size, each tested to its first failure.

    Returns
    -------
    Plan
        The plans, one for each number of failures allowed.

    Raises
    ------
    InputError
        If an argument is wrong, or no plan reaches the confidence; the message names the argument.

    Examples
    --------
    >>> import wearwell as ww
    >>> plan = ww.plan.demonstrate("B10 >= 1e6 cycles", failures="0 to 2")
    >>> [each["specimens"] for each in plan.summary["plans"]]
    [22, 38, 52]
    >>> plan = ww.plan.demonstrate("B10 >= 1e6 cycles", shape=2, specimens=10)
    >>> round(plan.summary["plans"][0]["time"])
    1479000
    >>> ww.plan.demonstrate("B10 >= 1e6 cycles", confidence=1.5)
    Traceback (most recent call last):
        ...
    wearwell.InputError: confidence: ...
    """
    return answer("demonstrate", {
        "goal": goal, "confidence": confidence, "failures": failures, "specimens": specimens, "time": time,
        "distribution": distribution, "shape": shape, "sigma": sigma, "truth": truth, "sudden_death": sudden_death,
    })


def accelerate(*, use, highest, until, specimens, stop=None, goal="B10", relation="arrhenius", family="weibull", shape=None, sigma=None,
               failing_at_use=None, failing_at_highest=None, life_at_highest=None, activation_energy=None, exponent=None, slope=None,
               lowest=None, low=None, middle_share=0.2, least_failures=4):
    """Plan an accelerated life test: levels of stress, specimens at each, and how well they predict a life in use.

    Planning values: ``shape`` or ``sigma``, and two of ``failing_at_use``, ``failing_at_highest`` (or
    ``life_at_highest``) and ``activation_energy`` (or ``exponent``, ``slope``). Each is a number, its 90 % interval
    "1.4 to 2", or a prior.

    Parameters
    ----------
    use : str or pint quantity
        Stress in use, "50 degC".
    highest : str or pint quantity
        Highest stress to test, "120 degC".
    until : str or pint quantity
        Stop time of every test, "183 d".
    specimens : int
        Number of specimens in all.
    stop : sequence of str or pint quantity, or str, optional
        Stop times of the lower, the middle and the highest level instead, ["365 d", "250 d", "183 d"]. Shares that fail stay those
        by ``until``.
    goal : str
        Life to predict at the stress in use, "B10".
    relation : {"arrhenius", "eyring", "inverse-power", "linear"}
        Relation of log life to stress.
    family : {"weibull", "lognormal", "loglogistic"}
        Distribution of lives.
    shape : float or str, optional
        Weibull shape.
    sigma : float or str, optional
        Instead: scale of the natural logarithm of life, of any family.
    failing_at_use : float or str, optional
        Share that fails in use by the stop time, "0.1 %".
    failing_at_highest : float or str, optional
        Share that fails at the highest stress by the stop time, "90 %".
    life_at_highest : str, optional
        Instead: median life there, "60 d", or another one, "B10 = 20 d".
    activation_energy : str or pint quantity, optional
        How steeply life falls by the relation of Arrhenius or Eyring, "0.7 eV".
    exponent : float or str, optional
        The same of an inverse power.
    slope : float or str, optional
        The same of a linear relation: fall of the natural logarithm of life per unit of stress.
    lowest : str or pint quantity, optional
        Lowest stress to test; by default that in use.
    low : str or pint quantity, optional
        Lower level of the plans with three levels; by default optimized.
    middle_share : float or str
        Share of specimens at the middle level of the compromise plan.
    least_failures : int
        Failures wanted at each level: their probability is reported.

    Returns
    -------
    Plan
        An optimum, a compromise, a 4:2:1 and an equal plan.

    Raises
    ------
    InputError
        If an argument is missing or wrong; the message names it.

    Examples
    --------
    An adhesive bond (Meeker and Escobar, Statistical Methods for Reliability Data, 1998, chapter 20):

    >>> import wearwell as ww
    >>> plan = ww.plan.accelerate(use="50 degC", highest="120 degC", until="183 d", specimens=300, sigma=0.6, failing_at_use=0.001,
    ...                           failing_at_highest=0.9)
    >>> [each["plan"] for each in plan.summary["plans"]]
    ['optimum', 'compromise', '4:2:1', 'equal']
    >>> [sum(level["specimens"] for level in each["levels"]) for each in plan.summary["plans"]]
    [300, 300, 300, 300]
    """
    return answer("accelerate", {
        "use": use, "highest": highest, "until": until, "specimens": specimens, "stop": stop, "goal": goal, "relation": relation,
        "family": family,
        "shape": shape, "sigma": sigma, "failing_at_use": failing_at_use, "failing_at_highest": failing_at_highest,
        "life_at_highest": life_at_highest, "activation_energy": activation_energy, "exponent": exponent, "slope": slope,
        "lowest": lowest, "low": low, "middle_share": middle_share, "least_failures": least_failures,
    })
