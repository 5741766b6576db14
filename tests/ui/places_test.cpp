// Where to look: the places where the maps differ, and their close-ups in a corner of each map.
#include <gtest/gtest.h>

#include <future>

#include "tests/image_part.hpp"
#include "tests/ui/explorer_fixtures.hpp"
#include "ui/explorer/observables.hpp"
#include "ui/panes/layout.hpp"
#include "ui/script/script.hpp"

namespace sweepscope::ui {
namespace {

bool contains(const PixelRect& outer, const PixelRect& inner) {
  return inner.left >= outer.left && inner.right() <= outer.right() && inner.top >= outer.top &&
         inner.bottom() <= outer.bottom();
}

class PlacesToLook : public testing::Test {
 protected:
  void SetUp() override { run("sample room-1\noffset-a 14\noffset-b 24\nwait solved\n"); }
  void run(const std::string& lines) {
    const auto done = run_script(ui_, *parse_script(lines, "test"), 300);
    ASSERT_TRUE(done) << done.error().message;
  }
  std::string now(const std::string& name) { return *observe(ui_.explorer(), name); }
  const ViewPoint& camera() { return ui_.explorer().settings().camera_a; }

  std::unique_ptr<gl::Context> context_ = *gl::make_offscreen_context(1200, 800);
  Ui ui_{*context_, Ui::Options()};
};

TEST_F(PlacesToLook, TheFirstPictureShowsTheBestOneInACornerOfBothMaps) {
  ASSERT_GT(ui_.explorer().places.all().size(), 1u);
  const PlaceToLook& best = *ui_.explorer().place();
  EXPECT_EQ(ui_.explorer().places.all().front().get(), &best);
  EXPECT_EQ(best.found.most_blurred(), 0u) << "map A is 10 ms off";
  const auto a = ui_.anchor("close-up a"), b = ui_.anchor("close-up b");
  ASSERT_TRUE(a && b);
  EXPECT_TRUE(contains(*ui_.anchor("map a"), *a));
  EXPECT_TRUE(contains(*ui_.anchor("map b"), *b));
  const Image picture = ui_.screenshot();
  EXPECT_NE(test::part_of(picture, *a), test::part_of(picture, *b));
}

TEST_F(PlacesToLook, TheMapIsFittedBesideTheCloseUp) {
  const PixelRect pane = *ui_.anchor("map b"), close_up = *ui_.anchor("close-up b");
  const Projection projection = projection_of(camera(), false, pane);
  const auto& points = ui_.explorer().pane(Side::kB).full->points->xyz_m;
  std::size_t hidden = 0, outside = 0;
  for (const auto& p : points) {
    const auto at = projection({p[0], p[1], p[2]});
    hidden += at && close_up.contains(*at) ? 1 : 0;
    outside += at && pane.contains(*at) ? 0 : 1;
  }
  EXPECT_LT(hidden, points.size() / 200);
  EXPECT_LT(outside, points.size() / 20);
}

TEST(CloseUps, ComeInTheFrameInWhichTheMapIsFittedBesideThem) {
  const auto context = *gl::make_offscreen_context(1200, 1100);
  Ui ui(*context, Ui::Options());
  ASSERT_TRUE(run_script(ui, *parse_script("sample room-1\noffset-a 14\noffset-b 24\n", "test"), 300));
  while (!ui.explorer().place()) ui.frame({}, 1.0 / 60);
  const ViewPoint first = ui.explorer().settings().camera_a;
  const PixelRect close_up = *ui.anchor("close-up a");
  ASSERT_TRUE(run_script(ui, *parse_script("wait solved\n", "test"), 300));
  EXPECT_EQ(ui.explorer().settings().camera_a, first);
  EXPECT_EQ(ui.anchor("close-up a")->top, close_up.top);
}

/// Beams of a stationary rig are placed at another offset before the map there is solved, if that takes long.
TEST(CloseUps, AndTheViewBesideThemDoNotDependOnWhetherPlacingOrSolvingEndsFirst) {
  Explorer explorer;
  test::perform(explorer, "sample room-1");
  test::rest(explorer);
  std::promise<void> may_solve;
  explorer.background.start("solve", "what takes long", "",
                            [open = may_solve.get_future().share()](const Job&) -> Background::Finish {
                              open.wait();
                              return {};
                            });
  test::perform(explorer, "offset-b 24");
  do explorer.update(0.25);
  while (!explorer.maps.has_all_points());
  EXPECT_FALSE(explorer.background.has("places")) << "not of a map that is still to come";
  EXPECT_FALSE(explorer.place());
  may_solve.set_value();
  test::rest(explorer);
  ASSERT_TRUE(explorer.place());
  const ViewPoint found = explorer.settings().camera_a;
  test::perform(explorer, "fit-view");
  EXPECT_EQ(explorer.settings().camera_a, found);
}

TEST_F(PlacesToLook, KeysButtonsAndTheListStepThroughThemAndRoundAtTheEnds) {
  const std::string first = now("place-at"), count = now("places");
  run("key N\nexpect place is 2");
  EXPECT_NE(now("place-at"), first);
  run("key Shift+N\nexpect place is 1\nkey Shift+N\nexpect place is " + count);
  run("click \"button next-place\"\nexpect place is 1\nclick \"button next-place back\"\nexpect place is " +
      count);
  run("click place\nclick \"place 2\"\nexpect place is 2\nkey Ctrl+P\ntype \"place 1\"\nkey Enter");
  EXPECT_EQ(now("place-at"), first);
}

TEST_F(PlacesToLook, AreSwitchedOffByAKeyAndTheMapHasAllOfItsPane) {
  const Eigen::Vector3d centre_m = camera().centre_m;
  run("key Y\nexpect close-up is off\nwait solved");
  EXPECT_FALSE(ui_.anchor("close-up a"));
  EXPECT_GT(camera().centre_m.y(), centre_m.y()) << "the map had been moved up";
  run("key N\nexpect close-up is on\nwait solved\nclick \"button close-up\"\nexpect close-up is off");
}

TEST_F(PlacesToLook, ADoubleClickLooksAtThePlace) {
  run("double-click \"close-up a\" at 0.5 0.7");
  const PlaceToLook& place = *ui_.explorer().place();
  EXPECT_LT((camera().centre_m.head<2>() - place.found.region.centre_m).norm(), 0.01);
  EXPECT_NEAR(camera().height_m, 1.5 * place.height_m(), 0.01);
}

TEST_F(PlacesToLook, OfEqualOffsetsAreNone) {
  run("offset-a 24\nwait solved\nexpect places is 0\nexpect place-at is \"\"");
  EXPECT_FALSE(ui_.anchor("close-up a"));
  const auto done = run_script(ui_, *parse_script("look-at-place", "test"), 300);
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("do not differ"), std::string::npos);
}

TEST_F(PlacesToLook, TheCloseUpFollowsAHandleWhileItIsDragged) {
  const PlacedCloudPtr before = ui_.explorer().pane(Side::kA).close_up;
  const std::string place = now("place-at");
  ASSERT_GT(before->points->size(), 1000u);
  run("mouse move \"handle a\"\nmouse down\nmouse move \"chart 0\" at 0.3 0.9\nmouse move \"chart 0\" at 0.35 0.9");
  const PlacedCloudPtr dragged = ui_.explorer().pane(Side::kA).close_up;
  EXPECT_NE(dragged, before);
  EXPECT_NE(dragged->points->xyz_m, before->points->xyz_m);
  EXPECT_EQ(now("place-at"), place) << "the place stays until the handle rests";
  run("mouse up");
}

TEST_F(PlacesToLook, ACloseUpHasTheMapsOwnPoints) {
  run("heights all\nwait solved");
  const PlaceToLook& place = *ui_.explorer().place();
  const Pane& pane = ui_.explorer().pane(Side::kB);
  std::map<std::uint32_t, std::array<float, 3>> of_map;
  for (std::size_t i = 0; i < pane.full->beams.size(); ++i)
    of_map[pane.full->beams[i]] = pane.full->points->xyz_m[i];
  for (std::size_t i = 0; i < pane.close_up->beams.size(); ++i)
    ASSERT_EQ(pane.close_up->points->xyz_m[i], of_map.at(pane.close_up->beams[i]));
  EXPECT_TRUE(std::is_sorted(place.beams.begin(), place.beams.end()));
}

TEST_F(PlacesToLook, BothCloseUpsChangeInTheSameFrame) {
  run("offset-b 20");
  for (int frame = 0; frame < 400 && !ui_.explorer().at_rest(); ++frame) {
    ui_.frame({}, 1.0 / 60);
    EXPECT_EQ(ui_.explorer().pane(Side::kA).close_up_place, ui_.explorer().pane(Side::kB).close_up_place);
  }
}

TEST_F(PlacesToLook, EveryLayoutShowsTheCloseUpsOfTheMapsThatItShows) {
  for (const auto& [layout, a, b] :
       {std::tuple{"side-by-side", true, true}, std::tuple{"swipe", true, true}, std::tuple{"a", true, false},
        std::tuple{"b", false, true}, std::tuple{"difference", false, true}}) {
    run(std::string("layout ") + layout + "\nwait solved");
    EXPECT_EQ(ui_.anchor("close-up a").has_value(), a) << layout;
    EXPECT_EQ(ui_.anchor("close-up b").has_value(), b) << layout;
  }
}

TEST(CloseUpPlaces, LieInThePictureBesideEachOtherAndLeaveMostOfIt) {
  for (const Layout layout : {Layout::kSideBySide, Layout::kSwipe}) {
    for (const auto& [width, height] : {std::pair{230.0, 340.0}, std::pair{320.0, 450.0},
                                        std::pair{1500.0, 1400.0}, std::pair{1600.0, 500.0}}) {
      const PixelRect picture{10, 20, width, height};
      const auto places = close_up_places(picture, 1, layout);
      double area = 0;
      for (std::size_t i = 0; i < places.size(); ++i) {
        EXPECT_TRUE(contains(picture, places[i]));
        area += places[i].width * places[i].height;
        EXPECT_TRUE(i == 0 || places[i - 1].right() <= places[i].left);
      }
      EXPECT_LT(area, 0.25 * width * height);
    }
  }
  EXPECT_TRUE(close_up_places({0, 0, 150, 400}, 1, Layout::kSideBySide).empty())
      << "too small to show anything";
}

}  // namespace
}  // namespace sweepscope::ui
