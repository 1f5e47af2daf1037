#include "core/files/data_url.hpp"

#include "support/catch.hpp"
using namespace tapstudy;

TEST_CASE("a file within an address is what base64 makes of it", "[core][files]") {
  // RFC 4648, section 10
  CHECK(core::data_url("image/png", "Man") == "data:image/png;base64,TWFu");
  CHECK(core::data_url("a/b", "foobar") == "data:a/b;base64,Zm9vYmFy");
  CHECK(core::data_url("a/b", "f") == "data:a/b;base64,Zg==");
  CHECK(core::data_url("a/b", "") == "data:a/b;base64,");
}
