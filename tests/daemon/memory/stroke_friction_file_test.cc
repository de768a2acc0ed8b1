#include "daemon/memory/stroke_friction_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace contour {
namespace {

namespace fs = std::filesystem;

const MappedAxis kAxis{"mill", "x", {-0.2, 0.2, 5e-3}, 1048576.0};

class StrokeFrictionFileTest : public testing::Test {
 protected:
  StrokeFrictionFileTest()
      : directory_(fs::temp_directory_path() / ("stroke_friction_" + std::to_string(getpid()))),
        file_(StrokeFrictionFile(directory_, kAxis)) {
    steps_.resize(StrokeFriction(kAxis.stroke).steps().size());
    for (std::size_t i = 0; i < steps_.size(); ++i)
      steps_[i] = {i % 2 == 0 ? 0.03 : -0.029, i % 2 == 0 ? 0.031 : -0.03, 4.0, 5.0};
  }
  ~StrokeFrictionFileTest() override { fs::remove_all(directory_); }

  std::string Text() const {
    std::ifstream in(file_);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void Put(const std::string& text) const { std::ofstream(file_) << text; }

  fs::path directory_, file_;
  std::vector<StrokeFriction::Step> steps_;
};

TEST_F(StrokeFrictionFileTest, ReadsBackWhatWasWritten) {
  WriteStrokeFriction(file_, kAxis, steps_);
  const StrokeFrictionRead read = ReadStrokeFriction(file_, kAxis);
  EXPECT_EQ(read.refused, "");
  ASSERT_EQ(read.steps.size(), steps_.size());
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    EXPECT_EQ(read.steps[i].forward, steps_[i].forward);
    EXPECT_EQ(read.steps[i].backward, steps_[i].backward);
    EXPECT_EQ(read.steps[i].forward_passes, steps_[i].forward_passes);
    EXPECT_EQ(read.steps[i].backward_passes, steps_[i].backward_passes);
  }
  // Nothing is left beside it.
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()), 1);
}

TEST_F(StrokeFrictionFileTest, RefusesWhatIsDamaged) {
  WriteStrokeFriction(file_, kAxis, steps_);
  const std::string whole = Text();
  for (const std::size_t length : {std::size_t{0}, whole.size() / 2, whole.size() - 1}) {
    Put(whole.substr(0, length));
    EXPECT_NE(ReadStrokeFriction(file_, kAxis).refused, "") << length;
  }
  for (std::size_t at = 0; at < whole.size(); at += 7) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    Put(damaged);
    EXPECT_NE(ReadStrokeFriction(file_, kAxis).refused, "") << at;
  }
  Put(whole + "more\n");
  EXPECT_NE(ReadStrokeFriction(file_, kAxis).refused, "");
  Put(whole);
  EXPECT_EQ(ReadStrokeFriction(file_, kAxis).refused, "");
  fs::remove(file_);
  EXPECT_NE(ReadStrokeFriction(file_, kAxis).refused, "");
}

TEST_F(StrokeFrictionFileTest, RefusesAnotherAxis) {
  WriteStrokeFriction(file_, kAxis, steps_);
  MappedAxis other = kAxis;
  other.axis = "y";
  EXPECT_EQ(ReadStrokeFriction(file_, other).refused, "it was learnt on another axis");
  other = kAxis;
  other.stroke.highest_m = 0.21;
  EXPECT_EQ(ReadStrokeFriction(file_, other).refused, "the axis had another stroke, screw or encoder");
  other = kAxis;
  other.encoder_counts_per_rev = 131072.0;
  EXPECT_EQ(ReadStrokeFriction(file_, other).refused, "the axis had another stroke, screw or encoder");
}

TEST_F(StrokeFrictionFileTest, RefusesWhatCannotBeFriction) {
  std::vector<StrokeFriction::Step> steps = steps_;
  steps[3].forward = 0.5;
  WriteStrokeFriction(file_, kAxis, steps);
  EXPECT_EQ(ReadStrokeFriction(file_, kAxis).refused,
            "friction cannot change that much from one piece to the next");
  for (StrokeFriction::Step& s : steps) s = {0.1, 0.1, 9.0, 9.0};
  WriteStrokeFriction(file_, kAxis, steps);
  EXPECT_EQ(ReadStrokeFriction(file_, kAxis).refused, "friction cannot vary that much along the stroke");
  steps.pop_back();
  WriteStrokeFriction(file_, kAxis, steps);
  EXPECT_EQ(ReadStrokeFriction(file_, kAxis).refused, "it has not one number for every step");
  steps_[1].backward = std::nan("");
  WriteStrokeFriction(file_, kAxis, steps_);
  EXPECT_NE(ReadStrokeFriction(file_, kAxis).refused, "");
}

}  // namespace
}  // namespace contour
