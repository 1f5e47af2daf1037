"""What python3-questplus makes of sequences of answers: the posterior after the last, the next
stimulus and its expected entropy; of every tenth sequence the estimates too
where they are asked for. Reads cases as JSON, writes a list for each."""
import json
import sys

import numpy as np
import scipy.stats
import xarray
from questplus import QuestPlus


def ordered_categories(qp):
    """Three outcomes by two logistic borders, at threshold and `slope` above it, in place of the
    likelihoods of two outcomes that the library makes."""
    grids = [*qp.stim_domain.values(), *qp.param_domain.values()]
    x, low, distance = np.meshgrid(*grids, indexing="ij")
    above = [1 / (1 + np.exp(-(x - border))) for border in (low, low + distance)]
    table = np.stack([1 - above[0], above[0] - above[1], above[1]])
    qp.outcome_domain = {"response": np.arange(3)}
    coordinates = {**qp.outcome_domain, **qp.stim_domain, **qp.param_domain}
    qp.likelihoods = xarray.DataArray(table, dims=list(coordinates), coords=coordinates)


def marginal_choice(qp, nuisances):
    """The least expected entropy of what is no nuisance, by SciPy's entropy."""
    joint = (qp.posterior * qp.likelihoods).sum(nuisances)
    others = [name for name in qp.param_domain if name not in nuisances]
    joint = joint.transpose("response", *qp.stim_domain, *others).values
    joint = joint.reshape(len(joint), -1, np.prod([len(qp.param_domain[name]) for name in others]))
    expected = (joint.sum(2) * scipy.stats.entropy(joint, axis=2)).sum(0)
    (values,) = qp.stim_domain.values()
    return [values[expected.argmin()]], expected.min()


def estimates(qp):
    """Of each parameter the mean, the mode, the standard deviation and the marginal posterior."""
    marginals = qp.marginal_posterior
    means = qp.param_estimate
    qp.param_estimation_method = "mode"
    modes = qp.param_estimate
    qp.param_estimation_method = "mean"
    for name, values in qp.param_domain.items():
        variance = np.sum(marginals[name] * (values - means[name]) ** 2)
        yield {"mean": means[name], "mode": modes[name], "sd": np.sqrt(variance),
               "marginal": marginals[name].tolist()}


def answers(case):
    qp = QuestPlus(outcome_domain={"response": [1, 0]}, **case["questplus"])
    if case.get("categories"):
        ordered_categories(qp)
    nuisances = case.get("nuisances", [])
    for number, sequence in enumerate(case["sequences"]):
        qp.posterior = qp.prior
        for values, outcome in sequence:
            qp.update(stim=dict(zip(qp.stim_domain, values)), outcome={"response": outcome})
        if nuisances:
            stimulus, entropy = marginal_choice(qp, nuisances)
        else:
            chosen = qp.next_stim
            stimulus, entropy = [chosen[name] for name in qp.stim_domain], qp.entropy
        order = sorted(qp.param_domain, key=nuisances.__contains__)
        posterior = qp.posterior.transpose(*order).values.ravel().tolist()
        is_asked = case.get("estimates") and number % 10 == 0
        answer = {"next": stimulus, "entropy": float(entropy), "posterior": posterior}
        yield {**answer, "estimates": list(estimates(qp)) if is_asked else []}


np.seterr(all="ignore")
json.dump([list(answers(case)) for case in json.load(sys.stdin)], sys.stdout)
