#include "analysis/figures/pdf_of_svg.hpp"

#include <cairo-pdf.h>
#include <librsvg/rsvg.h>

#include <memory>
#include <vector>

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

cairo_status_t append(void* pdf, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(pdf)->append(data, data + length);
  return CAIRO_STATUS_SUCCESS;
}

[[noreturn]] void refuse(GError* error) {
  const Owned<GError> owned{error};
  throw core::InvalidInput{std::string{"a figure is not SVG: "} +
                           (error == nullptr ? "it has no size" : error->message)};
}
}  // namespace

std::string pdf_of_svg(const std::string& svg) {
  GError* error = nullptr;
  const std::vector<guint8> bytes(svg.begin(), svg.end());
  const Owned<RsvgHandle> handle{rsvg_handle_new_from_data(bytes.data(), bytes.size(), &error)};
  RsvgRectangle page{};
  if (!handle ||
      rsvg_handle_get_intrinsic_size_in_pixels(handle.get(), &page.width, &page.height) == FALSE) {
    refuse(error);
  }
  page.width *= points_per_pixel;
  page.height *= points_per_pixel;
  std::string pdf;
  {
    const Owned<cairo_surface_t> surface{
        cairo_pdf_surface_create_for_stream(append, &pdf, page.width, page.height)};
    const Owned<cairo_t> context{cairo_create(surface.get())};
    if (rsvg_handle_render_document(handle.get(), context.get(), &page, &error) == FALSE) {
      refuse(error);
    }
  }  // which finishes the file
  return pdf;
}
}  // namespace tapstudy::analysis
