#pragma once
#include <stdexcept>
namespace tapstudy::core {
// The root of every error that tapstudy throws on purpose. What it says is one sentence for a
// person: where it went wrong, what was found, what is allowed.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
// The protocol, the rig or the command line asks for something that cannot be.
class InvalidInput : public Error {
 public:
  using Error::Error;
};
// A body that cannot be meshed, held or solved.
class ModelError : public Error {
 public:
  using Error::Error;
};
}  // namespace tapstudy::core
