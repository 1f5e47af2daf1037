#include "protocols/picture.hpp"

#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace std::string_literals;

namespace {
std::string svg(const std::string& inside, const std::string& attributes = "") {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\"" +
         attributes + ">" + inside + "</svg>\n";
}
const std::string png = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR and so on IEND\xae\x42\x60\x82"s;
}  // namespace

TEST_CASE("a picture's kind is what it holds, whatever its name", "[protocols][forms]") {
  CHECK(protocols::media_type_of_picture("a.jpg", png) == "image/png");
  CHECK(protocols::media_type_of_picture("a", "\xff\xd8\xff\xe0 and so on \xff\xd9") ==
        "image/jpeg");
  for (const std::string& drawing :
       {testing::contents(testing::source("tests/data/plates.svg")),
        "\xef\xbb\xbf<!-- > --><!DOCTYPE svg PUBLIC \"-//W3C//DTD SVG 1.1//EN\" \"a.dtd\">" +
            svg("<style><![CDATA[ .a > .b { fill: url('#c') } ]]></style><use xlink:href='#c'/>"),
        svg("<image href=\"data:image/png;base64,AAAA\"/><text a = '>'>a &lt; b</text>")}) {
    CHECK(protocols::media_type_of_picture("a.svg", drawing) == "image/svg+xml");
  }
}

TEST_CASE("what a page would not show, or could run, is no picture", "[protocols][forms]") {
  const auto [bytes, why] = GENERATE(table<std::string, std::string>({
      {"", "none of these"},
      {"BM windows bitmap", "none of these"},
      {"<html><body/></html>", "none of these"},
      {png.substr(0, 24), "breaks off"},
      {"\xff\xd8\xff\xe0", "breaks off"},
      {svg(std::string(1'000'000, ' ')), "bytes (at most 1000000)"},
      {svg("<script>alert(1)</script>"), "has an element 'script'"},
      {svg("<svg:SCRIPT href='#a'/>"), "has an element 'script'"},
      {svg("<foreignObject/>"), "has an element 'foreignobject'"},
      {svg("", " onload=\"alert(1)\""), "has an attribute 'onload'"},
      {svg("<a xlink:href=\"javascript:alert(1)\"/>"), "refers to other files"},
      {svg("<image href='https://example.org/a.png'/>"), "refers to other files"},
      {svg("<image href='data:text/html,a'/>"), "refers to other files"},
      {svg("<style>@import 'a.css';</style>"), "refers to other files"},
      {svg("<style><![CDATA[a { fill: url( \"a.svg\") }]]></style>"), "refers to other files"},
      {svg("<rect fill='url(a.svg#b)'/>"), "refers to other files"},
      {"<?xml-stylesheet href='a.css'?>" + svg(""), "refers to other files"},
      {"<!DOCTYPE svg [<!ENTITY a 'b'>]>" + svg("&a;"), "declares entities"},
      {svg("<g>"), "well-formed"},
      {svg("") + svg(""), "well-formed"},
      {svg("<g a=b/>"), "well-formed"},
      {svg("<!-- "), "well-formed"},
      {svg("<g a='"), "well-formed"},
  }));
  INFO(bytes.substr(0, 300));
  CHECK_THROWS_WITH(protocols::media_type_of_picture("a.svg", bytes),
                    Contains("a.svg: is not a picture that is shown") && Contains(why));
}
