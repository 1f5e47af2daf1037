#!/usr/bin/env bash
# liblo 0.31 (Debian 12, liblo7 0.31-1): a handler's arguments lie at addresses that are not aligned
# for the union they are declared as.
#
# Seen: a message of an int32 and a double. The second lo_arg* is 4 modulo 8 where alignof(lo_arg) is
# 8, both for the handler of a server that received the message and in lo_message_get_argv() of one
# that is put together. OSC pads arguments to four bytes, and liblo points into the message. The
# value, copied out byte by byte, is right. Debian's x86-64 reads arguments[1]->d all the same, but
# UndefinedBehaviorSanitizer reports it ("member access within misaligned address"). With the double
# first, all are aligned: whether a handler is sanitised clean depends on the order of arguments.
#
# So 64-bit arguments (d, h, t) are to be copied out by memcpy, also in tests that are sanitised.
. "$(dirname "$0")/support"
unpack liblo7=0.31-1 liblo-dev=0.31-1

cat >messages.c <<'PROGRAM'
#include <lo/lo.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static unsigned misalignment(const lo_arg* argument) {
  return (uintptr_t)argument % _Alignof(lo_arg);
}

static int hear(const char* path, const char* types, lo_arg** arguments, int count,
                lo_message message, void* data) {
  (void)types, (void)count, (void)message, (void)data;
  const int place = strcmp(path, "/double_first") != 0;
  double value;
  memcpy(&value, arguments[place], sizeof value);
  printf("%u %g\n", misalignment(arguments[place]), value);
  return 0;
}

int main(void) {
  lo_server server = lo_server_new(NULL, NULL);
  lo_server_add_method(server, NULL, NULL, hear, NULL);
  char port[8];
  snprintf(port, sizeof port, "%d", lo_server_get_port(server));
  lo_address address = lo_address_new("127.0.0.1", port);
  lo_send(address, "/double_second", "id", 3, 2.5);
  lo_send(address, "/double_first", "di", 2.5, 3);
  if (lo_server_recv_noblock(server, 2000) == 0) return 2;
  if (lo_server_recv_noblock(server, 2000) == 0) return 2;
  lo_message message = lo_message_new();
  lo_message_add_int32(message, 3);
  lo_message_add_double(message, 2.5);
  printf("%u %zu\n", misalignment(lo_message_get_argv(message)[1]), _Alignof(lo_arg));
  lo_message_free(message);
  lo_address_free(address);
  lo_server_free(server);
  return 0;
}
PROGRAM
cc -std=c11 -o messages messages.c -I"$root/usr/include" -L"$libraries" -llo
with_libraries ./messages >seen
{ read -r second value; read -r first _; read -r made alignment; } <seen
echo "the double is $second off after an int32, $first off before; $made off in a new message;" \
  "the union's alignment is $alignment"
still "the union asks for 8 bytes" [ "$alignment" = 8 ]
still "a received double after an int32 is 4 bytes off" [ "$second $value" = "4 2.5" ]
still "a received double before it is aligned" [ "$first" = 0 ]
still "a double in a message that is put together is 4 bytes off" [ "$made" = 4 ]
