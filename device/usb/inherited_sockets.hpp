#pragma once
namespace tapstudy::device {
// Closes the sockets that listen or are bound to a name of their own. A forked child without exec
// inherits them: the name of a session's lock and the port of its pages would stay taken for as
// long as the child lives. Only async-signal-safe functions are used.
void close_named_sockets() noexcept;
}  // namespace tapstudy::device
