#include <cairo-pdf.h>
#include <librsvg/rsvg.h>

#include <cmath>
#include <memory>
#include <vector>

#include "analysis/report/figures/image_formats.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double points_per_pixel = 0.75;  // CSS: 96 pixels an inch

struct Release {
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
  void operator()(GError* error) const { g_error_free(error); }
};
template <class T>
using Owned = std::unique_ptr<T, Release>;

cairo_status_t append(void* file, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(file)->append(data, data + length);
  return CAIRO_STATUS_SUCCESS;
}

[[noreturn]] void refuse(GError* error) {
  const Owned<GError> owned{error};
  throw core::InvalidInput{std::string{"a figure is not SVG: "} +
                           (error == nullptr ? "it has no size" : error->message)};
}

struct Drawing {
  Owned<RsvgHandle> handle;
  RsvgRectangle size{};  // [pixels]
};

Drawing read(const std::string& svg) {
  GError* error = nullptr;
  const std::vector<guint8> bytes(svg.begin(), svg.end());
  Drawing drawing{Owned<RsvgHandle>{rsvg_handle_new_from_data(bytes.data(), bytes.size(), &error)}};
  if (!drawing.handle ||
      rsvg_handle_get_intrinsic_size_in_pixels(drawing.handle.get(), &drawing.size.width,
                                               &drawing.size.height) == FALSE) {
    refuse(error);
  }
  return drawing;
}

void draw(const Drawing& drawing, const RsvgRectangle& page, cairo_surface_t* surface) {
  GError* error = nullptr;
  const Owned<cairo_t> context{cairo_create(surface)};
  if (rsvg_handle_render_document(drawing.handle.get(), context.get(), &page, &error) == FALSE) {
    refuse(error);
  }
}
}  // namespace

std::string pdf_of_svg(const std::string& svg) {
  const Drawing drawing = read(svg);
  RsvgRectangle page = drawing.size;
  page.width *= points_per_pixel;
  page.height *= points_per_pixel;
  std::string pdf;
  {
    const Owned<cairo_surface_t> surface{
        cairo_pdf_surface_create_for_stream(append, &pdf, page.width, page.height)};
    // equal figures are equal files, whenever they are made
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE,
                                   "2000-01-01T00:00:00Z");
    draw(drawing, page, surface.get());
  }  // which finishes the file
  return pdf;
}

std::string png_of_svg(const std::string& svg, int width) {
  const Drawing drawing = read(svg);
  const double height = std::round(width * drawing.size.height / drawing.size.width);
  const Owned<cairo_surface_t> surface{
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, static_cast<int>(height))};
  draw(drawing, {0.0, 0.0, static_cast<double>(width), height}, surface.get());
  std::string png;
  if (cairo_surface_write_to_png_stream(surface.get(), append, &png) != CAIRO_STATUS_SUCCESS) {
    throw core::InvalidInput{"a figure cannot be made a picture"};
  }
  return png;
}
}  // namespace tapstudy::analysis
