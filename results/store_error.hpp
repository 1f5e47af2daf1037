#pragma once
#include "core/error.hpp"
namespace tapstudy::results {
// The study's database cannot be opened, read or written.
class StoreError : public core::Error {
 public:
  using core::Error::Error;
};
// The database was deleted while in use, and all that it held was written anew: nothing is lost,
// but this session cannot go on with it.
class StoreRewritten : public StoreError {
 public:
  using StoreError::StoreError;
};
}  // namespace tapstudy::results
