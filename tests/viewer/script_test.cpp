// Scripts of the viewer: what a line means, and what is said of a wrong one.
#include <gtest/gtest.h>

#include <deltalux/error.hpp>
#include <script.hpp>

namespace deltalux::viewer {
namespace {

Script parsed(const std::string& text) { return parseScript(text, "s.script", "."); }

TEST(ViewerScript, ReadsActionsInOrder) {
  const Script script = parsed(
      "size 320 200\n# a comment\n\nwait settled 5\nselect dresser\ndrag 0 0.5 0 frames 7\n"
      "edit {\"op\": \"light\", \"light\": \"lamp\", \"scale\": 0.5}\nundo\nscreenshot window a.png\n");
  EXPECT_EQ(script.width, 320);
  EXPECT_EQ(script.height, 200);
  ASSERT_EQ(script.lines.size(), 6u);
  EXPECT_EQ(script.lines[0].line, 4);
  EXPECT_EQ(std::get<action::Wait>(script.lines[0].action).seconds, 5);
  EXPECT_EQ(std::get<action::Select>(script.lines[1].action).name, "dresser");
  const auto& drag = std::get<action::Drag>(script.lines[2].action);
  EXPECT_EQ(drag.offset, Vec3(0, 0.5, 0));
  EXPECT_EQ(drag.frames, 7);
  const auto& edit = std::get<Edit>(std::get<action::Apply>(script.lines[3].action).step);
  EXPECT_EQ(std::get<ScaleLight>(edit).factor, 0.5f);
  EXPECT_TRUE(std::holds_alternative<Undo>(std::get<action::Apply>(script.lines[4].action).step));
  const auto& shot = std::get<action::Screenshot>(script.lines[5].action);
  EXPECT_TRUE(shot.window);
  EXPECT_EQ(shot.file, "a.png");
}

TEST(ViewerScript, SaysWhatIsWrongAndWhere) {
  const std::pair<const char*, const char*> wrong[] = {
      {"wait settled\nscrenshot a.png", "screenshot"},
      {"\nundo now", "too many"},
      {"\ndrag 1 2", "offset"},
      {"\ndrag 1 2 x", "'x' is no number"},
      {"\ndrag 1 2 nan", "no number"},
      {"\nrotate 0 0 0 90", "without length"},
      {"\ncompare C 0.5", "A or B"},
      {"undo\nsize 10 10", "first"},
      {"\nsize 1 10", "16 to 8192"},
      {"\nfield 0 0 0 1 0 0 2 0 0", "span no area"},
      {"\nfalsecolour illuminance 0", "above 0"},
      {"\noverlay fog on", "no overlay"},
      {"\nedit {\"op\": \"light\"}", "light"},
      {"\nframes 0", "whole number"},
  };
  for (const auto& [text, says] : wrong) {
    try {
      parsed(text);
      ADD_FAILURE() << text << " was taken";
    } catch (const InputError& error) {
      EXPECT_EQ(error.file(), "s.script") << text;
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << text << ": " << error.what();
    }
  }
}

TEST(ViewerScript, ReadsScalesAndFields) {
  const auto f =
      std::get<action::False>(parsed("falsecolour illuminance 800 linear isolines bands 300 500").lines[0].action);
  EXPECT_EQ(f.falseColour.quantity, Quantity::Illuminance);
  EXPECT_FALSE(f.falseColour.logarithmic);
  EXPECT_TRUE(f.falseColour.isolines);
  EXPECT_EQ(f.falseColour.bands, (std::vector<double>{300, 500}));
  const auto field = *std::get<action::Field>(parsed("field 1 2 3 2 0 0 0 1 0 4 5").lines[0].action).field;
  EXPECT_EQ(field.normal, Vec3(0, 0, 1));
  EXPECT_EQ(field.columns, 4);
  EXPECT_EQ(field.rows, 5);
}

}  // namespace
}  // namespace deltalux::viewer
