#include <filesystem>
#include <fstream>

#include "fuzz/input.hpp"
#include "results/store.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tapstudy::fuzz::try_reading(data, size, [](const std::string& text) {
    const std::string directory = std::filesystem::temp_directory_path() / "tapstudy_fuzz_journal";
    std::filesystem::create_directories(directory);
    std::ofstream{tapstudy::results::journal_file(directory), std::ios::binary} << text;
    tapstudy::results::Store::from_journal(directory).answers();
  });
}
