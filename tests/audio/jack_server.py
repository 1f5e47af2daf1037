"""A server of JACK with the dummy driver, and a client that records what others play."""
import contextlib
import dataclasses
import os
import subprocess
import time

import jack
import numpy

RATE_HZ = 48000


def wait_until(what, condition, patience_s=120):
    end = time.monotonic() + patience_s
    while not (result := condition()):
        assert time.monotonic() < end, f"waited {patience_s} s for {what}"
        time.sleep(0.01)
    return result


@dataclasses.dataclass
class Server:
    name: str
    process: subprocess.Popen


@contextlib.contextmanager
def running_server():
    name = f"tapstudy_{os.getpid()}"
    daemon = subprocess.Popen(
        ["/usr/bin/jackd", "--no-realtime", "--name", name, "-d", "dummy", "-r", str(RATE_HZ), "-p", "256"],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        yield Server(name, daemon)
    finally:
        daemon.terminate()
        daemon.wait()


def environment_of(server):
    return {**os.environ, "JACK_DEFAULT_SERVER": server.name, "JACK_NO_START_SERVER": "1"}


class Recorder:
    """Records every audio output that appears, one channel each."""

    def __init__(self, server):
        self.client = jack.Client("recorder", no_start_server=True, servername=server.name)
        self.ports = [self.client.inports.register(f"in_{channel}") for channel in range(2)]
        self.blocks = []
        self.client.set_process_callback(
            lambda frames: self.blocks.append(numpy.array([port.get_array() for port in self.ports])))
        self.client.activate()

    @classmethod
    def of(cls, server):
        """As soon as the server answers."""
        def recorder():
            try:
                return cls(server)
            except jack.JackError:
                return None
        return wait_until("the server", recorder)

    def connect(self):
        outputs = self.client.get_ports(name_pattern="tapstudy|player", is_audio=True, is_output=True)
        if len(outputs) < len(self.ports):
            return False
        try:
            for output, port in zip(outputs, self.ports):
                if not port.connections:
                    self.client.connect(output, port)
        except jack.JackError:  # a port is named before its client is activated
            return False
        return True

    def heard(self):
        self.client.close()
        return numpy.concatenate(self.blocks, axis=1)
