// Catch2 3 where it is installed, else 2, under the names that both give: Approx, GENERATE, the
// matchers in Catch::Matchers, and Contains for a part of a text, which 3 calls ContainsSubstring.
#pragma once
#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>

using Catch::Approx;
inline auto Contains(const std::string& part) {
  return Catch::Matchers::ContainsSubstring(part);
}
#else
#include <catch2/catch.hpp>

using Catch::Matchers::Contains;
#endif
