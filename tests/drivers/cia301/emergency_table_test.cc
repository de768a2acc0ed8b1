#include "drivers/cia301/emergency_table.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

EmergencyReaction React(std::uint16_t code, std::uint8_t error_register = 0x01) {
  return ReactionTo({code, error_register});
}

TEST(EmergencyTable, ACodeOfTheManufacturerHasTheNameOfItsClass) {
  EXPECT_EQ(EmergencyText(0x8130), "heartbeat of the master missing");
  EXPECT_EQ(EmergencyText(0x3211), "DC link over-voltage");
  EXPECT_EQ(EmergencyText(0x2799), "current");
  EXPECT_EQ(EmergencyText(0xFF05), "specific to the device");
  EXPECT_EQ(EmergencyText(0), "no error");
  EXPECT_EQ(EmergencyText(0x0042), "unknown");
}

TEST(EmergencyTable, EachClassHasItsReaction) {
  EXPECT_EQ(React(0x0000), EmergencyReaction::kNone);
  EXPECT_EQ(React(0x1000), EmergencyReaction::kStopOnPath);
  EXPECT_EQ(React(0x2310), EmergencyReaction::kQuickStop);
  EXPECT_EQ(React(0x3220), EmergencyReaction::kQuickStop);
  EXPECT_EQ(React(0x4210), EmergencyReaction::kStopOnPath) << "there is time";
  EXPECT_EQ(React(0x5080), EmergencyReaction::kQuickStop);
  EXPECT_EQ(React(0x6180), EmergencyReaction::kQuickStop);
  EXPECT_EQ(React(0x7305), EmergencyReaction::kVoltageOff) << "no braking by an encoder that is faulty";
  EXPECT_EQ(React(0x73AB), EmergencyReaction::kVoltageOff);
  EXPECT_EQ(React(0x8120), EmergencyReaction::kWarn);
  EXPECT_EQ(React(0x8250), EmergencyReaction::kQuickStop);
  EXPECT_EQ(React(0x9000), EmergencyReaction::kStopOnPath);
  EXPECT_EQ(React(0xFF01), EmergencyReaction::kStopOnPath);
  EXPECT_EQ(React(0x0042), EmergencyReaction::kStopOnPath) << "an error of which nothing is known";
}

TEST(EmergencyTable, TheErrorRegisterMakesItStrongerNeverWeaker) {
  EXPECT_EQ(React(0xFF01, 0x03), EmergencyReaction::kQuickStop) << "current";
  EXPECT_EQ(React(0xFF01, 0x05), EmergencyReaction::kQuickStop) << "voltage";
  EXPECT_EQ(React(0x8110, 0x08), EmergencyReaction::kStopOnPath) << "temperature";
  EXPECT_EQ(React(0x7305, 0x00), EmergencyReaction::kVoltageOff);
}

TEST(EmergencyTable, KnowsWhichCodesSayThatTheMasterIsLost) {
  for (const int code : {0x8130, 0x8140, 0x8250, 0x8700})
    EXPECT_TRUE(SaysMasterLost(static_cast<std::uint16_t>(code))) << code;
  for (const int code : {0x8110, 0x8210, 0x3210, 0x0000})
    EXPECT_FALSE(SaysMasterLost(static_cast<std::uint16_t>(code))) << code;
}

TEST(EmergencyTable, ReadsCodesAndClasses) {
  EXPECT_TRUE(ParseEmergencyClass("0x4210")->Holds(0x4210));
  EXPECT_FALSE(ParseEmergencyClass("0x4210")->Holds(0x4211));
  EXPECT_TRUE(ParseEmergencyClass("0x42xx")->Holds(0x4210));
  EXPECT_FALSE(ParseEmergencyClass("0x42xx")->Holds(0x4310));
  EXPECT_TRUE(ParseEmergencyClass("0xFXXX")->Holds(0xFF05));
  for (const char* no : {"4210", "0x421", "0x42101", "0xxxxx", "0x4x10", "0x42g0", "", "0x0000", "0x"})
    EXPECT_FALSE(ParseEmergencyClass(no).has_value()) << no;
}

}  // namespace
}  // namespace contour
