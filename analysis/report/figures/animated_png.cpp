#include <boost/crc.hpp>
#include <cstdint>
#include <string_view>

#include "analysis/report/figures/image_formats.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::string_view signature{"\x89PNG\r\n\x1a\n"};

std::string big_endian(std::uint32_t number) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) {
    bytes += static_cast<char>(static_cast<unsigned char>(number >> static_cast<unsigned>(shift)));
  }
  return bytes;
}

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (const char byte : bytes.substr(at, 4)) {
    number = number << 8U | static_cast<unsigned char>(byte);
  }
  return number;
}

std::string chunk(const std::string& kind, const std::string& data) {
  boost::crc_32_type crc;
  const std::string checked = kind + data;
  crc.process_bytes(checked.data(), checked.size());
  return big_endian(static_cast<std::uint32_t>(data.size())) + checked +
         big_endian(static_cast<std::uint32_t>(crc.checksum()));
}

struct Image {
  std::string header;  // of IHDR
  std::string data;    // of all IDAT
};

Image image_in(std::string_view png) {
  if (!png.starts_with(signature)) {
    throw core::InvalidInput{"a frame of an animation is not a PNG"};
  }
  Image image;
  constexpr std::size_t around = 12;  // length, kind, checksum
  for (std::size_t at = signature.size(); at + around <= png.size();) {
    const std::size_t length = number_at(png, at);
    const std::string_view kind = png.substr(at + 4, 4);
    const std::string_view data = png.substr(at + 8, length);
    if (kind == "IHDR") {
      image.header = data;
    } else if (kind == "IDAT") {
      image.data += data;
    }
    at += around + length;
  }
  if (image.header.empty() || image.data.empty()) {
    throw core::InvalidInput{"a frame of an animation is not a complete PNG"};
  }
  return image;
}
}  // namespace

std::string animated_png(const std::vector<std::string>& frames, unsigned milliseconds_each) {
  if (frames.empty()) {
    throw core::InvalidInput{"an animation takes one frame or more"};
  }
  const std::string header = image_in(frames.front()).header;
  const auto count = static_cast<std::uint32_t>(frames.size());
  std::string file{signature};
  file += chunk("IHDR", header) + chunk("acTL", big_endian(count) + big_endian(0));
  std::uint32_t sequence = 0;
  for (const std::string& frame : frames) {
    const Image image = image_in(frame);
    if (image.header != header) {
      throw core::InvalidInput{"the frames of an animation are not of one size and format"};
    }
    const std::string delay = big_endian(milliseconds_each << 16U | 1000U);  // in thousandths
    const bool is_first = sequence == 0;
    // whole pictures: width and height as in the header, offsets 0, nothing disposed or blended
    file += chunk("fcTL", big_endian(sequence++) + header.substr(0, 8) + std::string(8, '\0') +
                              delay + std::string(2, '\0'));
    file +=
        is_first ? chunk("IDAT", image.data) : chunk("fdAT", big_endian(sequence++) + image.data);
  }
  return file + chunk("IEND", "");
}
}  // namespace tapstudy::analysis
