#include "analysis/statistics/file_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using namespace std::string_view_literals;

constexpr const char* save_as_csv = "save it as CSV there";
constexpr const char* unpack = "unpack it";
constexpr const char* write_csv_in_r = "write its table by write.csv() in R";
constexpr const char* to_csv_in_pandas = "write its table by to_csv() of pandas in Python";

constexpr const char* pickle = "a Python pickle, as PsychoPy's .psydat is";
constexpr const char* take_csv_beside = "take the CSV that PsychoPy writes beside it";

struct FileKind {
  std::string_view beginning;
  std::string_view within;  // in what can be read of the beginning, too; empty: anything
  const char* what;
  const char* cure;
};
constexpr std::array file_kinds{
    FileKind{"PK\3\4"sv, "xl/", "an Excel workbook", save_as_csv},
    FileKind{"PK\3\4"sv, "opendocument.spreadsheet", "a spreadsheet of LibreOffice", save_as_csv},
    FileKind{"PK\3\4"sv, "", "a zip archive", unpack},
    FileKind{"\xd0\xcf\x11\xe0"sv, "",
             "an Excel workbook, or another file of an old Office program", save_as_csv},
    FileKind{"\x1f\x8b"sv, "", "compressed by gzip, as R's own files are, too",
             "unpack it by gunzip; if R saved it, write its table by write.csv() in R"},
    FileKind{"BZh"sv, "", "compressed by bzip2", unpack},
    FileKind{"\xfd\x37zXZ"sv, "", "compressed by xz", unpack},
    FileKind{"\x28\xb5\x2f\xfd"sv, "", "compressed by zstd", unpack},
    FileKind{"7z\xbc\xaf"sv, "", "a 7z archive", unpack},
    FileKind{"$FL"sv, "", "a data file of SPSS", save_as_csv},
    FileKind{"<stata_dta>"sv, "", "a data file of Stata", "write it by export delimited in Stata"},
    FileKind{"HEADER RECORD*******"sv, "", "a transport file of SAS", save_as_csv},
    FileKind{"RDX"sv, "\nX\n", "a file that R saved", write_csv_in_r},
    FileKind{"X\n\0\0"sv, "", "a file that R saved", write_csv_in_r},
    FileKind{"PAR1"sv, "", "a Parquet file", to_csv_in_pandas},
    FileKind{"ARROW1"sv, "", "a Feather file", to_csv_in_pandas},
    FileKind{"\x93NUMPY"sv, "", "an array of NumPy", "write it by numpy.savetxt() in Python"},
    FileKind{"\x80\2"sv, "", pickle, take_csv_beside},
    FileKind{"\x80\3"sv, "", pickle, take_csv_beside},
    FileKind{"\x80\4"sv, "", pickle, take_csv_beside},
    FileKind{"SQLite format 3"sv, "", "a SQLite database",
             "a study of tapstudy is reported by its directory; of others export the table as CSV"},
    FileKind{"\x89HDF"sv, "", "an HDF5 file", to_csv_in_pandas},
    FileKind{"MATLAB 5.0 MAT-file"sv, "", "a MAT-file",
             "write its table by writetable() in MATLAB"},
    FileKind{"%PDF"sv, "", "a PDF", "copy its table into a spreadsheet and save it as CSV"}};

// A column of a table may be called PAR1.
bool has_control_characters(std::string_view bytes) {
  return std::ranges::any_of(bytes,
                             [](unsigned char c) { return c < '\t' || (c > '\r' && c < ' '); });
}
}  // namespace

void check_may_be_text(std::string_view beginning, const std::string& file) {
  const auto kind = std::ranges::find_if(file_kinds, [&](const FileKind& one) {
    return beginning.starts_with(one.beginning) &&
           beginning.find(one.within) != std::string_view::npos;
  });
  if (kind != file_kinds.end() && has_control_characters(beginning)) {
    throw core::InvalidInput{
        fmt::format("{}: is {}, not a table of text: {}", file, kind->what, kind->cure)};
  }
}
}  // namespace tapstudy::analysis
