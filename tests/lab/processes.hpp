#pragma once
#include <sys/types.h>
namespace tapstudy::lab {
// -1: it has none.
pid_t youngest_child(pid_t process);
// Every thread of the stopped process sleeps or waits, but for no answer from a socket.
bool is_at_rest(pid_t process);
}  // namespace tapstudy::lab
