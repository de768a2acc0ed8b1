#include "tools/replay/replay_run.h"

#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "config/load_machine.h"
#include "daemon/make_cycle_config.h"
#include "daemon/make_log_header.h"
#include "daemon/rt/cycle_parts.h"
#include "daemon/telemetry/flight_recorder.h"
#include "daemon/telemetry/tuning_note.h"
#include "tests/replay/eventful_run.h"
#include "tests/support/same_cycle_entry.h"
#include "tests/support/scratch_directory.h"
#include "tools/simulate/run_log.h"

namespace contour::test {
namespace {

namespace fs = std::filesystem;

const std::string kMachine = std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml";

EmulatedMachineFile Machine() { return LoadEmulatedMachine(kMachine); }

LogHeader Header(const std::vector<std::string>& more = {}) {
  const MachineSource source = ReadSource(kMachine, more);
  return MakeLogHeader(source, LoadMachine(source), "virtual", 0);
}

class ReplayTest : public ::testing::Test {
 protected:
  void SetUp() override { file_ = directory_ / "run.lcmlog"; }

  /// The log of a run with everything in it; what was seen.
  std::set<Reason> Record(std::uint64_t cycles, const LogHeader& header) const {
    EventfulRun run(Machine(), ControllerName::kFull);
    RunLog log(file_, header);
    run.machine().SetRecorder([&](const CycleEntry& entry) { log.Add(entry); });
    RunEverything(run, cycles);
    log.Close();
    return run.reasons();
  }
  /// A short log: bring-up, a circle and a stop.
  void RecordShort(const LogHeader& header, const std::function<bool(std::uint64_t)>& wanted = {}) const {
    EventfulRun run(Machine(), ControllerName::kFull);
    RunLog log(file_, header);
    run.machine().SetRecorder([&](const CycleEntry& entry) {
      if (!wanted || wanted(entry.input.cycle)) log.Add(entry);
    });
    run.BringUp();
    run.Enable();
    run.Start("{shape: circle, radius_mm: 0.1, turns: 2, frequency_hz: 4}", 200);
    run.Stop();
    log.Close();
  }
  ReplayReport ReplayFile(const ReplayOptions& options = {}) const {
    LogReader log(file_);
    return Replay(log, options);
  }
  std::string Content() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void Replace(const std::string& content) const {
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << content;
  }

  ScratchDirectory scratch_;
  const fs::path directory_ = scratch_.path();
  fs::path file_;
};

TEST_F(ReplayTest, AMinuteWithFaultsComesOutBitForBit) {
  const std::set<Reason> seen = Record(60'000, Header());
  for (const Reason reason : {Reason::kBusDown, Reason::kEmergencyStop, Reason::kFollowingError,
                              Reason::kDriveFault, Reason::kIoStale, Reason::kOperatorStop,
                              Reason::kDisableRequest, Reason::kProgramEnd, Reason::kTerminate})
    EXPECT_TRUE(seen.contains(reason)) << Name(reason);
  const ReplayReport report = ReplayFile();
  EXPECT_EQ(report.verdict, ReplayVerdict::kSame) << report.message;
  EXPECT_GE(report.cycles, 59'500u);
  EXPECT_EQ(report.first_cycle, 1u);
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.recorded_build, report.replayed_build);
  for (const QuantityDifference& d : report.differences)
    ADD_FAILURE() << d.quantity << " at cycle " << d.cycle << ": " << d.recorded << " " << d.replayed;
}

TEST_F(ReplayTest, AChangeOfWhatIsComputedIsFoundWithItsCycleAndQuantity) {
  // The log claims a configuration that differs in the last digit of one tuning value.
  RecordShort(Header({"estimator.mass_std=0.0500000001"}));
  const ReplayReport report = ReplayFile();
  EXPECT_EQ(report.verdict, ReplayVerdict::kDiffers);
  ASSERT_FALSE(report.differences.empty());
  const QuantityDifference& first = report.differences.front();
  EXPECT_GT(first.cycle, 1u);
  EXPECT_NE(first.recorded, first.replayed);
  ASSERT_TRUE(first.largest.has_value());
  EXPECT_GT(*first.largest, 0.0);
  for (const QuantityDifference& d : report.differences) EXPECT_GE(d.cycle, first.cycle) << d.quantity;
}

TEST_F(ReplayTest, AToleranceTakesSmallDifferencesAndNoLargeOnes) {
  RecordShort(Header({"estimator.mass_std=0.0500000001"}));
  EXPECT_EQ(ReplayFile({.tolerance = 1e-3}).verdict, ReplayVerdict::kWithinTolerance);
  EXPECT_EQ(ReplayFile({.tolerance = 1e-15}).verdict, ReplayVerdict::kDiffers);
  RecordShort(Header({"estimator.mass_std=0.5"}));
  EXPECT_EQ(ReplayFile({.tolerance = 1e-3}).verdict, ReplayVerdict::kDiffers);
}

TEST_F(ReplayTest, SaysThatAnotherBuildRecorded) {
  LogHeader header = Header();
  header.build = "contourd 0.0.9, some other compiler";
  RecordShort(header);
  const ReplayReport report = ReplayFile();
  EXPECT_EQ(report.verdict, ReplayVerdict::kSame) << "the results are the same all the same";
  EXPECT_NE(report.recorded_build, report.replayed_build);
}

/// Where each cycle's entry lies in a log, by bytes.
struct Place {
  std::uint64_t cycle;
  std::size_t begin, end;
};

std::vector<Place> PlacesOfCycles(const std::string& bytes) {
  const auto u32 = [&](std::size_t at) {
    std::uint32_t v = 0;
    for (std::size_t i = 0; i < 4; ++i) v = (v << 8) | static_cast<unsigned char>(bytes[at + i]);
    return v;
  };
  std::vector<Place> places;
  std::uint64_t cycle = 0;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t channel = u32(at + 20), data = u32(at + 24), begin = at + 28 + channel;
    if (bytes.substr(at + 28, channel) == "CONTOUR_CYCLES") {
      const std::size_t count = u32(begin + 20);
      std::size_t entry = begin + 24;
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t length = u32(begin + data - 8 * count + 4 * i);
        places.push_back({++cycle, entry, entry + length});
        entry += length;
      }
    }
    at = begin + data;
  }
  return places;
}

TEST_F(ReplayTest, AChangedBitIsFoundAtItsCycle) {
  RecordShort(Header());
  const std::string whole = Content();
  const std::vector<Place> places = PlacesOfCycles(whole);
  ASSERT_GT(places.size(), 400u);
  std::mt19937 random(1);
  for (std::size_t i = 0; i < places.size(); i += 19) {
    const Place& place = places[i];
    std::string damaged = whole;
    const std::size_t byte = place.begin + random() % (place.end - place.begin);
    damaged[byte] = static_cast<char>(damaged[byte] ^ (1 << (random() % 8)));
    Replace(damaged);
    const ReplayReport report = ReplayFile();
    EXPECT_EQ(report.verdict, ReplayVerdict::kDamaged);
    EXPECT_EQ(report.damaged_cycle, place.cycle);
    EXPECT_TRUE(report.differences.empty()) << "the file is damaged, the result does not differ";
    EXPECT_NE(report.message.find(std::to_string(place.cycle)), std::string::npos) << report.message;
  }
}

TEST_F(ReplayTest, NoBitOfTheFileCanChangeUnnoticed) {
  RecordShort(Header());
  const std::string whole = Content();
  std::mt19937 random(2);
  for (int i = 0; i < 150; ++i) {
    std::string damaged = whole;
    // A third of them where events begin: headers of events are no part of any message.
    std::size_t byte = random() % whole.size();
    if (i % 3 == 0) {
      byte = whole.find("\xED\xA1\xDA\x01", byte);
      if (byte == std::string::npos) continue;
      byte += random() % 45;
    }
    damaged[byte] = static_cast<char>(damaged[byte] ^ (1 << (random() % 8)));
    Replace(damaged);
    try {
      const ReplayReport report = ReplayFile();
      EXPECT_TRUE(report.verdict == ReplayVerdict::kDamaged || report.verdict == ReplayVerdict::kIncomplete ||
                  report.verdict == ReplayVerdict::kCutShort)
          << "byte " << byte << ": " << Name(report.verdict);
    } catch (const LogError&) {
      // The header itself: there is nothing to replay.
    }
  }
}

TEST_F(ReplayTest, StopsWhereCyclesAreMissing) {
  RecordShort(Header(), [](std::uint64_t cycle) { return cycle < 300 || cycle > 302; });
  const ReplayReport report = ReplayFile();
  EXPECT_EQ(report.verdict, ReplayVerdict::kIncomplete);
  EXPECT_EQ(report.last_cycle, 299u);
  EXPECT_NE(report.message.find("3 cycles are missing after cycle 299"), std::string::npos) << report.message;
}

// As on a disk that became full: the log is closed, and nothing in it follows the gap.
TEST_F(ReplayTest, CyclesThatAreMissingAtTheEndAreMissed) {
  {
    EventfulRun run(Machine(), ControllerName::kFull);
    LogWriter writer(file_, Header());
    TelemetryEncoder encoder({}, 1000, Header().axis_names);
    TelemetrySink* sinks[] = {&writer};
    run.machine().SetRecorder([&](const CycleEntry& entry) { encoder.Add(entry, sinks); });
    run.BringUp();
    encoder.Flush(sinks);
    writer.Lose(5, 0, "No space left on device");
  }
  const ReplayReport report = ReplayFile();
  EXPECT_EQ(report.verdict, ReplayVerdict::kIncomplete);
  EXPECT_TRUE(report.closed);
  EXPECT_NE(report.message.find("5 cycles are missing at the end"), std::string::npos) << report.message;
}

TEST_F(ReplayTest, ALogCutShortIsTheSameUpToThere) {
  RecordShort(Header());
  const std::string whole = Content();
  Replace(whole.substr(0, whole.size() * 2 / 3));
  const ReplayReport report = ReplayFile();
  EXPECT_EQ(report.verdict, ReplayVerdict::kCutShort) << report.message;
  EXPECT_TRUE(report.differences.empty());
  EXPECT_FALSE(report.closed);
  EXPECT_GT(report.cycles, 100u);
}

TEST_F(ReplayTest, AModelInAFileOfItsOwnComesWithTheLog) {
  fs::create_directories(directory_ / "models");
  std::ofstream(directory_ / "models" / "x.yaml")
      << "lead_mm: 5\nmotor_inertia_kgm2: 5e-5\ntable_mass_kg: 11.5\n"
         "screw_stiffness_N_um: 40\nscrew_damping_Ns_m: 1100\n"
         "friction: {acts_on: table, Fs_plus_N: 52, Fs_minus_N: 47, "
         "Fc_plus_N: 42, Fc_minus_N: 36, vs_mm_s: 2, sigma0_N_m: "
         "5e6, sigma1_Ns_m: 3000, sigma2_Ns_m: 500}\n";
  const fs::path copy = directory_ / "machine.yaml";
  fs::copy_file(kMachine, copy);
  const MachineSource source = ReadSource(copy.string(), {"axes.x.model=models/x.yaml"});
  ASSERT_EQ(source.files.size(), 1u);
  fs::remove_all(directory_ / "models");
  fs::remove(copy);
  EXPECT_EQ(LoadMachine(source).axes.at("x").model.mechanics.table_mass_kg, 11.5);
  const LogHeader header = MakeLogHeader(source, LoadMachine(source), "virtual", 0);
  EXPECT_EQ(SourceOf(header).files, source.files);
}

/// Gains that change in the middle of a run, as `contour reload` changes them.
TEST_F(ReplayTest, ChangedGainsAreChangedAgainAtTheSameCycle) {
  const std::string change = "control.full.contour_bandwidth_Hz=25\ncontrol.planner.torque_share=0.5";
  const LogHeader header = Header();
  const auto tuned = [&] {
    MachineSource source = SourceOf(header);
    for (const std::string& line : Lines(change)) source.overrides.push_back(line);
    return MakeController(MakeCycleConfig(LoadMachine(source), ControllerName::kFull));
  };
  const auto record = [&](bool with_note) {
    EventfulRun machine(Machine(), ControllerName::kFull);
    RunLog log(file_, header);
    machine.machine().SetRecorder([&](const CycleEntry& entry) { log.Add(entry); });
    machine.BringUp();
    machine.Enable();
    machine.Start("{shape: circle, radius_mm: 0.1, turns: 4, frequency_hz: 4}", 200);
    ContourController next = tuned();
    if (with_note) log.Note(kTuningNote + std::string("1"), change);
    machine.machine().mailbox().PostTune(next, 1);
    machine.Tick(400);
    EXPECT_GT(machine.machine().record().acknowledged, 2u);
    EXPECT_EQ(machine.machine().record().state, MachineState::kRunning);
    log.Close();
  };
  record(true);
  const ReplayReport report = ReplayFile();
  EXPECT_EQ(report.verdict, ReplayVerdict::kSame);
  for (const QuantityDifference& d : report.differences) ADD_FAILURE() << d.quantity << " at " << d.cycle;
  record(false);
  EXPECT_THROW(ReplayFile(), LogError) << "without the note nobody can know what was changed";
}

/// A controller of another kind cannot take over: refused, nothing changes, and the replay knows it.
TEST_F(ReplayTest, GainsThatTheControllerCannotTakeAreRefused) {
  EventfulRun machine(Machine(), ControllerName::kFull);
  RunLog log(file_, Header());
  machine.machine().SetRecorder([&](const CycleEntry& entry) { log.Add(entry); });
  machine.BringUp();
  machine.Enable();
  machine.Start("{shape: circle, radius_mm: 0.1, turns: 4, frequency_hz: 4}", 200);
  const MachineSource source = SourceOf(Header());
  ContourController other = MakeController(MakeCycleConfig(LoadMachine(source), ControllerName::kPid));
  const std::uint32_t sequence = machine.machine().mailbox().PostTune(other, 1);
  machine.Tick(200);
  EXPECT_EQ(machine.machine().record().acknowledged, sequence);
  EXPECT_FALSE(machine.machine().record().acknowledged_ok);
  EXPECT_EQ(machine.machine().record().state, MachineState::kRunning);
  log.Close();
  EXPECT_EQ(ReplayFile().verdict, ReplayVerdict::kSame);
}

class FlightRecordTest : public ReplayTest {
 protected:
  /// A long run through a flight recorder of 1.5 s; the files it left.
  std::vector<fs::path> Fly(EventfulRun& run, const std::function<void(EventfulRun&)>& script,
                            std::uint64_t window_cycles = 1500) {
    FlightRecorder::Config config;
    config.directory = directory_ / "flight";
    config.window_cycles = window_cycles;
    FlightRecorder recorder(config, Header());
    TelemetryEncoder encoder({}, 1000, Header().axis_names);
    TelemetrySink* sinks[] = {&recorder};
    Cycle shadow(MakeCycleConfig(Machine().machine, ControllerName::kFull));
    std::string state(shadow.StateSize(), '\0');
    CycleOutput ignored;
    run.machine().SetRecorder([&](const CycleEntry& entry) {
      shadow.Step(entry.input, ignored);
      if (entry.input.cycle % 400 == 7) {
        shadow.SaveState(std::as_writable_bytes(std::span(state)));
        recorder.OnState(entry.input.cycle, state);
      }
      recorder.OnCycle(entry);
      encoder.Add(entry, sinks);
    });
    script(run);
    encoder.Flush(sinks);
    EXPECT_TRUE(recorder.Finish(std::chrono::steady_clock::now() + std::chrono::minutes(1)));
    stats_ = recorder.stats();
    std::vector<fs::path> files;
    if (fs::exists(config.directory))
      for (const auto& file : fs::directory_iterator(config.directory)) files.push_back(file.path());
    std::sort(files.begin(), files.end());
    return files;
  }
  FlightRecordStats stats_;
};

TEST_F(FlightRecordTest, TheLastSecondsBeforeAFaultAreKeptAndComeOutBitForBit) {
  EventfulRun run(Machine(), ControllerName::kFull);
  const std::vector<fs::path> files = Fly(run, [](EventfulRun& r) {
    r.BringUp();
    r.Enable();
    r.Start("{shape: circle, radius_mm: 10, turns: 5, feed_mm_min: 900}", 4000);
    r.EmergencyStop();
    r.Reset();
    r.Enable();
    r.Start("{shape: circle, radius_mm: 0.1, turns: 9, frequency_hz: 1}", 300);
    r.FailDrive();
  });
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(stats_.written, 2u);
  EXPECT_EQ(stats_.reason, "drive_fault");
  EXPECT_EQ(stats_.last_error, "");
  EXPECT_EQ(fs::path(stats_.file), files[1]);
  for (const fs::path& file : files) {
    LogReader log(file);
    // An earlier fault may lie within the window: the last one counts.
    MachineState state = MachineState::kOff;
    std::uint64_t fault_cycle = 0;
    ReplayOptions options;
    options.observer = [&](const CycleEntry& e) {
      const CycleRecord& r = e.output.record;
      if (r.state == MachineState::kFaulted && state != r.state) fault_cycle = r.cycle;
      state = r.state;
    };
    const ReplayReport report = Replay(log, options);
    EXPECT_EQ(report.verdict, ReplayVerdict::kSame) << file << ": " << report.message;
    EXPECT_GE(fault_cycle, report.first_cycle + 1500);
    EXPECT_LE(fault_cycle, report.first_cycle + 2000);
    EXPECT_GE(report.last_cycle, fault_cycle + 100);
    EXPECT_GT(report.first_cycle, 1u);
    EXPECT_TRUE(report.closed);
  }
}

TEST_F(FlightRecordTest, AFaultSoonAfterTheStartIsRecordedFromTheStart) {
  EventfulRun run(Machine(), ControllerName::kFull);
  const std::vector<fs::path> files = Fly(
      run,
      [](EventfulRun& r) {
        r.BringUp();
        r.Enable();
        r.EmergencyStop();
      },
      3000);  // longer than the start, which listens first
  ASSERT_EQ(files.size(), 1u);
  LogReader log(files[0]);
  const ReplayReport report = Replay(log);
  EXPECT_EQ(report.verdict, ReplayVerdict::kSame) << report.message;
  EXPECT_EQ(report.first_cycle, 1u);
}

TEST_F(FlightRecordTest, AnotherBuildSaysThatItCannotReadTheState) {
  EventfulRun run(Machine(), ControllerName::kFull);
  RunLog log(file_, Header());
  log.State({5, "contourd of another kind", "abc"});
  run.machine().SetRecorder([&](const CycleEntry& entry) {
    if (entry.input.cycle > 5) log.Add(entry);
  });
  run.BringUp();
  log.Close();
  try {
    ReplayFile();
    FAIL() << "read the state of another build";
  } catch (const LogError& e) {
    EXPECT_NE(std::string(e.what()).find("contourd of another kind"), std::string::npos);
  }
}

class CycleState : public ::testing::TestWithParam<ControllerName> {};

/// A second cycle that takes over the state in the middle of a run computes the same from there on.
TEST_P(CycleState, GoesOnElsewhereAsIfItHadBeenThere) {
  const EmulatedMachineFile file = Machine();
  const CycleConfig config = MakeCycleConfig(file.machine, GetParam());
  std::vector<CycleEntry> entries;
  EventfulRun run(file, GetParam());
  run.machine().SetRecorder([&](const CycleEntry& entry) { entries.push_back(entry); });
  run.BringUp();
  run.Enable();
  run.Start("{shape: square, side_mm: 0.4, feed_mm_min: 300, corners: velocity_jump}", 150);
  run.Stop();
  run.Start("{shape: circle, radius_mm: 10, turns: 2, feed_mm_min: 900}", 300);
  run.EmergencyStop();
  run.Reset();
  run.Enable();
  Cycle original(config);
  std::vector<std::byte> state(original.StateSize());
  std::vector<std::unique_ptr<Cycle>> heirs;
  CycleOutput expected, out;
  for (const CycleEntry& entry : entries) {
    if (entry.input.cycle % 97 == 0) {
      original.SaveState(state);
      heirs.push_back(std::make_unique<Cycle>(config));
      ASSERT_TRUE(heirs.back()->LoadState(state));
    }
    original.Step(entry.input, expected);
    for (const auto& heir : heirs) {
      heir->Step(entry.input, out);
      ExpectSame(expected.record, out.record);
      ASSERT_EQ(expected.frames.size(), out.frames.size());
      for (std::size_t i = 0; i < out.frames.size(); ++i) ExpectSame(expected.frames[i], out.frames[i]);
      ASSERT_FALSE(HasFailure()) << "cycle " << entry.input.cycle;
    }
  }
  EXPECT_GE(heirs.size(), 15u);
}

TEST(CycleStateTest, RefusesWhatIsNoStateOfIt) {
  const CycleConfig config = MakeCycleConfig(Machine().machine, ControllerName::kFull);
  Cycle cycle(config);
  std::vector<std::byte> state(cycle.StateSize());
  cycle.SaveState(state);
  EXPECT_TRUE(cycle.LoadState(state));
  EXPECT_FALSE(cycle.LoadState(std::span(state).first(state.size() - 8)));
  state.resize(state.size() + 8);
  EXPECT_FALSE(cycle.LoadState(state));
}

INSTANTIATE_TEST_SUITE_P(EveryController, CycleState,
                         ::testing::Values(ControllerName::kPid, ControllerName::kCsp, ControllerName::kMpc,
                                           ControllerName::kMpcObserver, ControllerName::kMpcSrukf4,
                                           ControllerName::kMpcEkf7, ControllerName::kMpcSrukf7,
                                           ControllerName::kFull),
                         [](const auto& name) { return std::string(Name(name.param)); });

}  // namespace
}  // namespace contour::test
