#include <filesystem>
#include <fstream>

#include "fuzz/input.hpp"
#include "results/store/store.hpp"
#include "results/store/study_queries.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tapstudy::fuzz::try_reading(data, size, [](const std::string& text) {
    const std::string directory = std::filesystem::temp_directory_path() / "tapstudy_fuzz_journal";
    std::filesystem::create_directories(directory);
    std::ofstream{tapstudy::results::journal_file(directory), std::ios::binary} << text;
    auto store = tapstudy::results::Store::from_journal(directory);
    tapstudy::results::stored_answers(store);
  });
}
