"""What a report says was rendered, against NumPy on the same traces.

    compare_with_numpy.py STUDY REPORT.json PROTOCOL.yaml

Reads traces by results/read_trace.py and takes taps as the report defines them: 200 ticks from an
impact on, or fewer to the next tap; an impact within 50 ms after a release is a rebound.
"""
import collections
import json
import os
import sqlite3
import sys

import numpy as np
import yaml
from scipy import optimize, stats

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "../../../../results"))
sys.dont_write_bytecode = True
import read_trace

PARTS = {"contact spring": "penalty_n", "vibration": "vibration_n",
         "decaying sinusoid": "sinusoid_n"}


def first_impacts(trace):
    found = []
    alternative, touching, time = trace["alternative"], trace["touching"], trace["t_ns"]
    for i in np.flatnonzero(trace["impact"]):
        begin = np.flatnonzero(alternative[:i] != alternative[i])
        begin = begin[-1] + 1 if len(begin) else 0
        before = np.flatnonzero(touching[begin:i])
        if len(before) == 0 or (not touching[i - 1] and
                                time[i] - time[begin + before[-1] + 1] >= 50_000_000):
            found.append(i)
    return found


def taps_of(trace):
    impacts = first_impacts(trace)
    for i, following in zip(impacts, impacts[1:] + [len(trace)]):
        piece = trace[i:min(i + 200, following)]
        switch = np.flatnonzero(piece["alternative"] != piece["alternative"][0])
        yield piece[:switch[0]] if len(switch) else piece


def mean_at_each_tick(forces):
    rows = np.full((len(forces), 200), np.nan)
    for row, force in zip(rows, forces):
        row[:len(force)] = force
    used = ~np.isnan(rows).all(axis=0)
    with np.errstate(all="ignore"):
        return (~np.isnan(rows[:, used])).sum(axis=0), np.nanmean(rows[:, used], axis=0)


def spread(forces, tick):
    values = [force[tick] for force in forces if len(force) > tick]
    return np.std(values, ddof=1) if len(values) > 1 else None


def close(value, expected, what):
    np.testing.assert_allclose(np.array(value, float), np.array(expected, float), rtol=1e-9,
                               atol=1e-15, err_msg=what)


def main(study, report, protocol):
    database = os.path.join(study, "study.db")
    said = json.load(open(report))["study"]
    with open(protocol) as file:
        written = yaml.safe_load(file)
    scale = written["placement"]["lateral_scale"]
    origin = np.array(written["placement"].get("origin_m", [0, 0, 0]))
    points = written["tapping_points_m"]
    by_stimulus = collections.defaultdict(list)
    by_point = collections.defaultdict(list)
    connection = sqlite3.connect(database)
    by_participant = collections.defaultdict(list)
    for trial, person in connection.execute(
            "SELECT trial_id, participant_id FROM v_trials WHERE status = 'answered' AND "
            "NOT is_practice AND NOT is_catch AND NOT is_excluded"):
        names = [name for (name,) in connection.execute(
            "SELECT stimulus FROM alternative WHERE trial_id = ? ORDER BY position", (trial,))]
        for tap in taps_of(read_trace.trace(database, trial)):
            stimulus = names[tap["alternative"][0]]
            hand = np.array([tap[f"position_{axis}_m"][0] for axis in "xyz"]) - origin
            at = np.array([hand[0], -hand[2]]) / scale
            far = {name: np.hypot(*(np.array(place) - at)) for name, place in points.items()}
            by_stimulus[stimulus].append(tap)
            by_participant[person].append(tap)
            by_point[stimulus, min(far, key=far.get)].append((tap, min(far.values())))
    assert len(by_stimulus) > 1
    check_stimuli(said, by_stimulus)
    check_participants(said, by_participant)
    check_points(said, by_point)


def check_participants(said, by_participant):
    *people, mean = said["rendered_participants"]
    assert [row["participant_id"] for row in people] == sorted(by_participant)
    for row in people:
        taps = by_participant[row["participant_id"]]
        peaks = [np.max(np.linalg.norm([tap[f"force_{axis}_n"] for axis in "xyz"], axis=0))
                 for tap in taps]
        close(row["peak_n"], np.median(peaks), "peak_n")
        close(row["contact_s"], np.mean([tap["touching"].sum() / 1000 for tap in taps]), "contact_s")
    peaks = [row["peak_n"] for row in people]
    half = stats.t.ppf(0.975, len(peaks) - 1) * stats.sem(peaks)
    middle = np.mean(peaks)
    # the upper end is that of the score with a variance in proportion to the mean
    high = optimize.brentq(lambda end: (end - middle) ** 2 - half**2 * end / middle, middle,
                           1e3 * middle, xtol=1e-14)
    close([mean["peak_n_low"], mean["peak_n"], mean["peak_n_high"]],
          [max(0.0, middle - half), middle, high], "mean peak_n")


def check_stimuli(said, by_stimulus):
    assert {row["stimulus"] for row in said["rendered_taps"]} == set(by_stimulus)
    for row in said["rendered_taps"]:
        taps = by_stimulus[row["stimulus"]]
        assert row["taps"] == len(taps)
        speeds = [-tap["velocity_y_m_s"][0] for tap in taps]
        peaks = [np.max(np.linalg.norm([tap[f"force_{axis}_n"] for axis in "xyz"], axis=0))
                 for tap in taps]
        for key, values in (("speed_m_s", speeds), ("peak_n", peaks)):
            close([row[key + "_low"], row[key], row[key + "_high"]],
                  np.percentile(values, [25, 50, 75]), key)
    parts = collections.Counter()
    for row in said["rendered_forces"]:
        name = PARTS.get(row["part"])
        if not name:
            continue
        parts[row["part"]] += 1
        taps = by_stimulus[row["stimulus"]]
        held = np.concatenate([tap[name][tap["touching"] == 1] for tap in taps])
        peaks = [np.max(np.abs(tap[name])) for tap in taps]
        close(row["rms_n"], np.sqrt(np.mean(held ** 2)), "RMS")
        close(row["largest_peak_n"], max(peaks), "largest peak")
        close(row["peak_n"], np.median(peaks), "peak")
    assert parts["contact spring"] == len(by_stimulus) and len(parts) > 1, parts


def check_points(said, by_point):
    for row in said["rendered_points"]:
        pairs = by_point[row["stimulus"], row["point"]]
        assert row["taps"] == len(pairs)
        close(row["distance_m"], np.median([far for _, far in pairs]), "distance")
    assert len(said["rendered_points"]) == len(by_point)
    waveforms = collections.defaultdict(list)
    for row in said["rendered_waveforms"]:
        waveforms[row["stimulus"], row["point"]].append(row)
    spectra = collections.defaultdict(list)
    for row in said["rendered_spectra"]:
        spectra[row["stimulus"], row["point"]].append(row)
    assert set(waveforms) == set(by_point) and len(spectra) > 1
    for key, pairs in by_point.items():
        added = [tap["vibration_n"] + tap["sinusoid_n"] for tap, _ in pairs]
        total = [tap["penalty_n"] + tap["vibration_n"] + tap["sinusoid_n"] for tap, _ in pairs]
        for name, forces in (("added_n", added), ("total_n", total)):
            count, mean = mean_at_each_tick(forces)
            close([row["taps"] for row in waveforms[key]], count, "taps")
            close([row["time_s"] for row in waveforms[key]], np.arange(len(count)) / 1000, "time")
            close([row[name] for row in waveforms[key]], mean, name)
            for tick in (0, 7, len(count) - 1):
                expected = spread(forces, tick)
                shown = waveforms[key][tick][name.replace("_n", "_sd_n")]
                assert (expected is None) == (shown is None), (expected, shown)
                if expected is not None:
                    np.testing.assert_allclose(shown, expected, rtol=1e-6, atol=1e-12)
        magnitudes = np.abs([np.fft.rfft(force, 200) for force in added]) / 1000
        if np.any(magnitudes):
            close([row["added_n_per_hz"] for row in spectra[key]],
                  np.sqrt(np.mean(magnitudes ** 2, axis=0)), "spectrum")
            close([row["frequency_hz"] for row in spectra[key]], np.fft.rfftfreq(200, 1e-3), "Hz")
        else:
            assert key not in spectra


main(*sys.argv[1:])
