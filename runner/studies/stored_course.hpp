#pragma once
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "results/store/store.hpp"
namespace tapstudy::runner {
// What is stored of the course of a study's sessions, held against what a session can be.
struct CheckedCourse {
  // Groups that are not those of their participants' order indices, trials that are not those of
  // their session's order (block, practice, what they present),
  // changes of state that no session makes, actions that no operator has; a sentence each.
  std::vector<std::string> wrong;
  // Sessions that were neither ended nor stopped: a program that was killed leaves one.
  std::vector<std::string> open_sessions;
  // Sessions whose order this version would draw otherwise: their trials are not held against it.
  int unknown_orders{};
};
CheckedCourse checked_course(results::Store& store, const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
