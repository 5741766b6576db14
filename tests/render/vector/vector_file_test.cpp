#include "render/vector/vector_file.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

/// Marks of each kind; every text that has ever gone wrong somewhere.
Picture flat_picture() {
  Picture picture{300, 200, {20, 23, 28}, {}, {}};
  picture.marks.add(TextMark{{10, 30}, "θ < −3.1 ± 0.2 & 10³ …", 14, {255, 255, 255}});
  picture.marks.add(
      TextMark{{150, 60}, "bold \"x\"", 14, {1, 2, 3}, AlignX::kCentre, AlignY::kBaseline, true});
  picture.marks.add(LineMark{{{10, 100}, {60.5, 110}, {90, 90}}, 1.5, {255, 128, 0, 51}, 4});
  picture.marks.fill({10, 120, 50, 20}, {0, 255, 0});
  picture.marks.add(AreaMark{{{100, 150}, {110, 140}, {120, 150}}, 160, {0, 0, 255}});
  return picture;
}

Picture picture_with_view() {
  Picture picture = flat_picture();
  ColouredPoints points;
  for (int i = 0; i < 2000; ++i)
    points.add({0.01F * static_cast<float>(i % 100), 0.02F * static_cast<float>(i / 100), 0}, 1);
  View view;
  view.place = {180, 100, 100, 80};
  view.scene.clouds.push_back({std::make_shared<const ColouredPoints>(std::move(points)), 2});
  view.scene.background = {90, 0, 0};
  picture.views.push_back(std::move(view));
  return picture;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// What a PDF's compressed streams hold, one after the other.
std::string streams_of(const std::string& pdf) {
  std::string all;
  for (std::size_t at = pdf.find("\nstream\n"); at != std::string::npos;
       at = pdf.find("\nstream\n", at + 1)) {
    const std::size_t from = at + 8, to = pdf.find("endstream", from);
    std::string out(1 << 22, '\0');
    uLongf length = out.size();
    const auto* bytes = reinterpret_cast<const Bytef*>(pdf.data() + from);
    if (uncompress(reinterpret_cast<Bytef*>(out.data()), &length, bytes, to - from) == Z_OK)
      all += out.substr(0, length);
  }
  return all;
}

const std::vector<PngText> kTexts{{"Title", "Figure 4"},
                                  {"Software", "sweepscope test"},
                                  {"Equation", "t_motor = t_laser + offset"},
                                  {"Recipe", "a & b"}};

TEST(SvgFile, HoldsTextAsTextWithItsWidth) {
  const auto svg = encode_svg(flat_picture());
  ASSERT_TRUE(svg);
  EXPECT_NE(svg->find(">θ &lt; −3.1 ± 0.2 &amp; 10³ …</text>"), std::string::npos);
  EXPECT_NE(svg->find("text-anchor=\"middle\" font-weight=\"bold\" textLength="), std::string::npos);
  EXPECT_EQ(count_of(*svg, "<text "), 2U);
}

TEST(SvgFile, HoldsShapesWithTheirColours) {
  const std::string svg = encode_svg(flat_picture()).value();
  EXPECT_NE(
      svg.find(
          "<polyline points=\"10,100 60.5,110 90,90\" fill=\"none\" stroke-width=\"1.5\" "
          "stroke-linejoin=\"round\" stroke-dasharray=\"4\" stroke=\"#ff8000\" stroke-opacity=\"0.2\"/>"),
      std::string::npos);
  EXPECT_NE(svg.find("<polygon points=\"10,120 60,120 60,140 10,140\" fill=\"#00ff00\"/>"),
            std::string::npos);
  EXPECT_NE(svg.find("<polygon points=\"100,150 110,140 120,150 120,160 100,160\" fill=\"#0000ff\"/>"),
            std::string::npos);
  EXPECT_NE(svg.find("<rect width=\"300\" height=\"200\" fill=\"#14171c\"/>"), std::string::npos);
}

TEST(SvgFile, ATransparentBackgroundIsNone) {
  Picture picture = flat_picture();
  picture.background.alpha = 0;
  EXPECT_EQ(encode_svg(picture)->find("<rect"), std::string::npos);
}

TEST(SvgFile, HoldsHowItWasMade) {
  const std::string svg = encode_svg(flat_picture(), kTexts).value();
  EXPECT_NE(svg.find("<title>Figure 4</title>"), std::string::npos);
  EXPECT_NE(svg.find("<s:text key=\"Recipe\">a &amp; b</s:text>"), std::string::npos);
}

TEST(SvgFile, BytesThatAreNotUtf8DoNotBreakIt) {
  Picture picture = flat_picture();
  picture.marks.add(TextMark{{10, 30}, "walk\xff\x01.bag", 14, {}});
  EXPECT_NE(encode_svg(picture)->find(">walk\\xff\\x01.bag</text>"), std::string::npos);
  EXPECT_TRUE(encode_pdf(picture));
}

TEST(SvgFile, AViewIsAnImageAndFlatPicturesHaveNone) {
  EXPECT_EQ(count_of(*encode_svg(flat_picture()), "<image "), 0U);
  const std::string svg = encode_svg(picture_with_view()).value();
  EXPECT_EQ(count_of(svg,
                     "<image x=\"180\" y=\"100\" width=\"100\" height=\"80\" "
                     "xlink:href=\"data:image/png;base64,iVBORw0KGgo"),
            1U);
}

TEST(PdfFile, HoldsItsFontsAndWhichLettersTheyShow) {
  const std::string pdf = encode_pdf(flat_picture()).value();
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  EXPECT_NE(pdf.find("+DejaVuSans"), std::string::npos);
  EXPECT_NE(pdf.find("DejaVuSans-Bold"), std::string::npos);
  EXPECT_NE(pdf.find("/ToUnicode"), std::string::npos);
  const std::string streams = streams_of(pdf);
  EXPECT_NE(streams.find("<03b8>"), std::string::npos);  // theta
  EXPECT_NE(streams.find("<2212>"), std::string::npos);  // minus
}

TEST(PdfFile, HoldsHowItWasMadeAndNoClock) {
  const std::string pdf = encode_pdf(flat_picture(), kTexts).value();
  EXPECT_NE(pdf.find("/Title (Figure 4)"), std::string::npos);
  EXPECT_NE(pdf.find("/Creator (sweepscope test)"), std::string::npos);
  EXPECT_NE(pdf.find("/Subject (Equation: t_motor = t_laser + offset"), std::string::npos);
  EXPECT_EQ(pdf.find("Date"), std::string::npos);
}

TEST(PdfFile, HasThePicturesSizeInPoints) {
  EXPECT_NE(encode_pdf(flat_picture())->find("/MediaBox [ 0 0 225 150 ]"), std::string::npos);
}

TEST(PdfFile, AViewIsAnImageOfTwiceItsSize) {
  EXPECT_EQ(encode_pdf(flat_picture())->find("/Subtype /Image"), std::string::npos);
  const std::string pdf = encode_pdf(picture_with_view()).value();
  EXPECT_EQ(count_of(pdf, "/Subtype /Image"), 1U);
  EXPECT_NE(pdf.find("/Width 200"), std::string::npos);
  EXPECT_NE(pdf.find("/Height 160"), std::string::npos);
}

TEST(VectorFiles, AreTheSameToTheByteEachTime) {
  const Picture picture = picture_with_view();
  EXPECT_EQ(*encode_svg(picture, kTexts), *encode_svg(picture, kTexts));
  EXPECT_EQ(*encode_pdf(picture, kTexts), *encode_pdf(picture, kTexts));
}

TEST(VectorFiles, ASizeThatCannotBeDrawnIsRefused) {
  Picture picture = flat_picture();
  picture.width_px = 9000;
  EXPECT_EQ(encode_svg(picture).error().code, ExitCode::kWrongUsage);
  EXPECT_EQ(encode_pdf(picture).error().message,
            "A picture of 9000 x 200 pixels cannot be drawn: each side is 64 to 8000 pixels");
}

class WritePicture : public test::FolderTest {};

TEST_F(WritePicture, TakesTheKindFromTheExtension) {
  const Picture picture = flat_picture();
  for (const char* name : {"a.png", "a.svg", "a.PDF"}) ASSERT_TRUE(write_picture(folder_ / name, picture));
  EXPECT_EQ(test::contents_of(folder_ / "a.png").substr(1, 3), "PNG");
  EXPECT_EQ(test::contents_of(folder_ / "a.svg"), *encode_svg(picture));
  EXPECT_EQ(test::contents_of(folder_ / "a.PDF"), *encode_pdf(picture));
}

TEST_F(WritePicture, RefusesOtherKindsAndLeavesNothing) {
  const auto written = write_picture(folder_ / "a.jpg", flat_picture());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(written.error().message.find("a.jpg: a picture is written as .png, .svg or .pdf"),
            std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace sweepscope
