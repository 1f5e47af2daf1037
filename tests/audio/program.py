"""A session of the program with masking noise on a card."""
import os
from pathlib import Path

from noise_laws import GAIN_DB, MASKING

PROGRAM = os.environ["TAPSTUDY_PROGRAM"]
SOURCE = Path(__file__).resolve().parents[2]


def session_on(card, directory):
    """The command, as a list; its study is `study` in the directory."""
    protocol = directory / "study.yaml"
    protocol.write_text((SOURCE / "protocols/paper/discrimination.yaml").read_text() +
                        f"\nmasking: {MASKING}\n")
    rig = directory / "rig.yaml"
    rig.write_text((SOURCE / "protocols/rigs/simulated_hand.yaml").read_text() +
                   f'\naudio: {{card: "{card}", gain_db: {GAIN_DB}}}\n')
    return [PROGRAM, "run", protocol, "--rig", rig, "--participant", "P01", "--seed", "5", "--out",
            directory / "study"]
