#include "analysis/diagnosis/quantification/written_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "analysis/diagnosis/quantification/quantify.h"
#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

class WrittenModelTest : public testing::Test {
 protected:
  Diagnosis Written(bool something_left) {
    Accepted accepted;
    accepted.fit = axis_.With(axis_.Of("constant_torque"));
    accepted.places = {0};
    accepted.scatter = {1.0};
    Diagnosis found;
    found.causes.emplace_back();
    found.causes[0].kind = "constant_torque";
    const Fit fit = Quantify(axis_.problem, axis_.base, accepted, {}, found);
    DescribeModel(axis_.problem, axis_.base, fit, accepted, something_left, found);
    return found;
  }

  // A torque of 0.3 Fc that the model does not have.
  test::FittedAxis axis_{{{"constant_torque", 0.3, 0.0, 0.0, 0.0}}};
};

TEST_F(WrittenModelTest, HasTheFittedNumbersTheCausesAndWhatTheyAreWorth) {
  const Diagnosis found = Written(false);
  ASSERT_TRUE(found.fitted);
  EXPECT_NE(found.fitted->friction.Fc_plus, axis_.made.axis.stated.friction.Fc_plus);
  ASSERT_EQ(found.in_model.size(), 1u);
  EXPECT_EQ(found.in_model[0].parameters.at("torque_Nm").value,
            found.causes[0].parameters.at("torque_Nm").value);
  ASSERT_EQ(found.model_errors.size(), 3u);
  EXPECT_LT(found.model_errors[2].free_run_unseen, 0.5 * found.model_errors[0].free_run_unseen);
}

TEST_F(WrittenModelTest, ACompleteModelIsKeptWhateverIsSaidToBeLeft) {
  // Free runs foresee no better what is foreseen as well as the noise lets it be.
  const Diagnosis complete = Written(false), doubted = Written(true);
  EXPECT_EQ(doubted.fitted->motor_inertia, complete.fitted->motor_inertia);
  EXPECT_TRUE(std::none_of(doubted.notes.begin(), doubted.notes.end(), [](const std::string& note) {
    return note.find("foresee free runs best") != std::string::npos;
  }));
}

}  // namespace
}  // namespace contour::diagnosis
