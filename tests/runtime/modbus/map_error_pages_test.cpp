// The pages of the errors of register maps keep their word: the failing text fails with that number alone, the mended
// one gives a map.
#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <string>

#include "runtime/config/modbus_reader.hpp"
#include "runtime/modbus/register_map.hpp"
#include "support/errors.hpp"
#include "tests/support/error_page.hpp"

namespace hysteron::runtime::modbus {
namespace {

/// The diagram that the pages speak of.
const std::vector<Point>& points() {
  static const std::vector<Point> list{
      {.name = "U", .kind = PointKind::output, .type = PointType::real64, .unit = "V"},
      {.name = "GAIN", .kind = PointKind::parameter, .type = PointType::real64, .unit = "V", .writable = true},
      {.name = "MODE", .kind = PointKind::parameter, .type = PointType::int16, .unit = "1", .writable = true},
  };
  return list;
}

MapRequest request_of(const test::FencedBlock& block) {
  MapRequest request{.title = "PAGE", .lock_file = "page.lock"};
  if (block.kind == "text lock") {
    request.lock_text = block.text;
    return request;
  }
  const auto file = toml::parse(block.text);
  RunConfig config;
  Diagnostics found;
  const std::string name = "run.toml";
  ModbusReader reader(name, config, found);
  const auto* const server = file["modbus"].as_table();
  const toml::table empty;
  reader.read(server == nullptr ? &empty : server, false);
  reader.read_points(file["addresses"].as_table(), file["registers"].as_table());
  EXPECT_FALSE(found.has_errors());
  request.given = config.modbus->registers;
  request.expose = config.modbus->expose;
  request.expose_place = config.modbus->expose_place;
  return request;
}

class MapErrorPages : public ::testing::TestWithParam<int> {};

TEST_P(MapErrorPages, FailAndMend) {
  const auto page = test::read_error_page("HY" + std::to_string(GetParam()));
  try {
    (void)make_register_map(points(), request_of(page.fails));
    ADD_FAILURE() << "the failing text does not fail";
  } catch (const InputError& refused) {
    ASSERT_EQ(refused.diagnostics().all().size(), 1U);
    const Diagnostic& only = refused.diagnostics().all().front();
    EXPECT_EQ(only.number, GetParam());
    EXPECT_FALSE(only.place.file.empty());
    EXPECT_FALSE(only.mend.empty());
  }
  const MapRequest mended = request_of(page.mended);
  EXPECT_EQ(make_register_map(points(), mended).entries().size(), mended.expose.empty() ? points().size() : 2);
}

INSTANTIATE_TEST_SUITE_P(Modbus, MapErrorPages, ::testing::Values(820, 821, 822, 823, 824, 825, 826, 860, 861),
                         [](const auto& page) { return "HY" + std::to_string(page.param); });

TEST(RegisterMapErrors, AreFoundTogether) {
  const MapRequest request{.title = "T",
                           .given = {{"NONE", "%QW0"}, {"GAIN", "?"}, {"MODE", "%QX0.0"}},
                           .lock_file = "t.lock",
                           .lock_text = "what\nholding 0 int16 A\nholding 0 int16 B\n"};
  try {
    (void)make_register_map(points(), request);
    FAIL();
  } catch (const InputError& refused) {
    std::vector<int> numbers;
    for (const Diagnostic& one : refused.diagnostics().all()) {
      numbers.push_back(one.number);
    }
    EXPECT_EQ(numbers, (std::vector<int>{826, 824, 825, 821, 820}));
  }
}

TEST(RegisterMapErrors, AnAreaThatIsFull) {
  std::vector<Point> many(801, {.type = PointType::boolean, .writable = true});
  for (std::size_t i = 0; i < many.size(); ++i) {
    many[i].name = "B" + std::to_string(i);
  }
  EXPECT_NO_THROW((void)make_register_map(std::span(many).first(800), {.title = "T", .placing = Placing::openplc}));
  try {
    (void)make_register_map(many, {.title = "T", .placing = Placing::openplc});
    FAIL();
  } catch (const InputError& refused) {
    EXPECT_EQ(refused.diagnostics().all().front().number, error::no_address_left);
  }
}

TEST(RegisterMapErrors, MorePointsThanAnAreaHolds) {
  std::vector<Point> many(chain_address + 1, {.type = PointType::int16, .writable = true});
  for (std::size_t i = 0; i < many.size(); ++i) {
    many[i].name = "WORD" + std::to_string(i);
  }
  EXPECT_THROW((void)make_register_map(many, {.title = "T"}), InputError);
  EXPECT_NO_THROW((void)make_register_map(many, {.title = "T", .has_discovery = false}));
}

}  // namespace
}  // namespace hysteron::runtime::modbus
