#pragma once
#include "core/error.hpp"
namespace tapstudy::results {
// The study's database cannot be opened, read or written.
class StoreError : public core::Error {
 public:
  using core::Error::Error;
};
}  // namespace tapstudy::results
