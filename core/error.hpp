#pragma once
#include <stdexcept>
namespace tapstudy::core {
// Base class of every error that tapstudy throws deliberately. The message is one sentence for the
// user: where the error occurred, what was found, what is allowed.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
// The protocol, the rig or the command line is invalid.
class InvalidInput : public Error {
 public:
  using Error::Error;
};
// Data of which a statistic cannot be estimated: too few, all alike, or not connected. A report
// says so and goes on.
class NotEstimable : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};
// A body that cannot be meshed, constrained or solved.
class ModelError : public Error {
 public:
  using Error::Error;
};
// Damping that does not fit the modes of a body.
class DampingError : public ModelError {
 public:
  using ModelError::ModelError;
};
}  // namespace tapstudy::core
