#!/usr/bin/python3
"""with_logind.py PROGRAM [ARGUMENT ...]: runs the program on a system bus of its own, where a mock of
logind answers; says what was inhibited while it ran, and whether it still is."""
import os
import subprocess
import sys
import time

import dbus


def inhibitors(logind):
    return [tuple(map(str, one[:4])) for one in logind.ListInhibitors()]


def watch(program):
    logind = dbus.Interface(
        dbus.SystemBus().get_object("org.freedesktop.login1", "/org/freedesktop/login1"),
        "org.freedesktop.login1.Manager",
    )
    seen = set()
    while program.poll() is None:
        seen.update(inhibitors(logind))
        time.sleep(0.02)
    for one in seen:
        print("inhibited:", *one)
    print("still inhibited:", len(inhibitors(logind)))


def main():
    bus = subprocess.Popen(
        ["dbus-daemon", "--session", "--nofork", "--print-address"], stdout=subprocess.PIPE, text=True
    )
    os.environ["DBUS_SYSTEM_BUS_ADDRESS"] = bus.stdout.readline().strip()
    mock = subprocess.Popen(
        ["/usr/bin/python3", "-m", "dbusmock", "--system", "--template", "logind"],
        stdout=subprocess.DEVNULL,
    )
    try:
        for _ in range(500):
            if dbus.SystemBus().name_has_owner("org.freedesktop.login1"):
                break
            time.sleep(0.02)
        with subprocess.Popen(sys.argv[1:]) as program:
            watch(program)
        return program.returncode
    finally:
        mock.kill()
        bus.kill()


sys.exit(main())
