#!/usr/bin/env bash
# JACK 1.9.21 (Debian 12, jackd2, libjack-jackd2-0 and libjack-jackd2-dev 1.9.21~dfsg-3): a client that
# does not answer stops every client behind it for as long as it does not, whatever --timeout says.
#
# Seen: a server with the dummy driver, periods of 256 frames at 48 kHz and --timeout 500 (ms, "client
# timeout limit" in its manual), and three clients: a player, a recorder that is connected to it, and
# one that is connected to nothing. Each counts its process callbacks: 187 or 188 a second. The player
# is stopped (SIGSTOP), as a debugger or a full machine does it. The recorder's callback is not called
# once in the next five seconds, that of the lone client 187 times in each. The server logs
# "client = player was not finished" and keeps both connected. They go on when the player does.
#
# So what is recorded or played behind another client's port, a masking noise through a mixer, say,
# ceases with that client, and nobody is told: the callback, where it could be noticed, is not called. Whoever needs to know counts callbacks from a thread of its own.
. "$(dirname "$0")/support"
unpack jackd2=1.9.21~dfsg-3 libjack-jackd2-0=1.9.21~dfsg-3 libjack-jackd2-dev=1.9.21~dfsg-3
export JACK_DEFAULT_SERVER=finding JACK_NO_AUDIO_RESERVATION=1 JACK_DRIVER_DIR=$libraries/jack

cat >client.c <<'PROGRAM'
#include <jack/jack.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static jack_port_t *in, *out;
static volatile long periods;

static int process(jack_nframes_t frames, void* none) {
  (void)none;
  if (out != NULL) {
    memset(jack_port_get_buffer(out, frames), 0, frames * sizeof(float));
  }
  periods += in == NULL || jack_port_get_buffer(in, frames) != NULL;
  return 0;
}

/* Its name says what it is; prints the callbacks of each second. */
int main(int count, char** words) {
  jack_client_t* client = jack_client_open(words[count - 1], JackNoStartServer, NULL);
  if (client == NULL) {
    return 1;
  }
  if (strcmp(words[1], "player") == 0) {
    out = jack_port_register(client, "out", JACK_DEFAULT_AUDIO_TYPE, JackPortIsOutput, 0);
  } else {
    in = jack_port_register(client, "in", JACK_DEFAULT_AUDIO_TYPE, JackPortIsInput, 0);
  }
  jack_set_process_callback(client, process, NULL);
  jack_activate(client);
  if (strcmp(words[1], "recorder") == 0) {
    jack_connect(client, "player:out", "recorder:in");
  }
  for (;;) {
    long before = periods;
    sleep(1);
    printf("%ld\n", periods - before);
    fflush(stdout);
  }
}
PROGRAM
gcc -I"$root/usr/include" client.c -o client "$libraries/libjack.so.0"
export LD_LIBRARY_PATH=$libraries
"$root/usr/bin/jackd" -n finding -t 500 -d dummy -r 48000 -p 256 >server.log 2>&1 &
trap 'kill -KILL $(jobs -p); rm -rf "$folder"' EXIT
sleep 2
./client player >player.log &
player=$!
sleep 1
./client recorder >recorder.log &
./client lone >lone.log &
sleep 3
kill -STOP "$player"
sleep 7
kill -CONT "$player"
sleep 3

# Seconds with no callback, and with nearly as many as there are.
silent() { awk '$1 == 0 {++n} END {print n + 0}' "$1.log"; }
full() { awk '$1 > 150 {++n} END {print n + 0}' "$1.log"; }
echo "recorder: $(tr '\n' ' ' <recorder.log)"
echo "lone: $(tr '\n' ' ' <lone.log)"

still "a client behind a stopped one is not called" [ "$(silent recorder)" -ge 5 ]
still "another is called as before" [ "$(silent lone)" -eq 0 ]
still "it goes on with the one before it" [ "$(full recorder)" -ge 3 ]
still "the server keeps the stopped one connected" is "$(grep -c 'zombi' server.log || true) == 0"
