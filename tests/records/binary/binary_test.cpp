// Records of MATLAB, HDF5 and WAV: what becomes a column, what its time is, and that no broken file does harm.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "records/read.hpp"
#include "records/record.hpp"
#include "support/diagnostic.hpp"
#include "tests/records/binary/binary_files.hpp"

namespace hysteron::records::test {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

const std::vector<double> time_values{0.0, 0.001, 0.002, 0.003};
const std::vector<double> u_values{0.1, 0.25, -0.5, 1.0 / 3.0};

/// What a file gives, or HYnnn and its cause.
Record read(const std::string& name, std::string bytes, const ReadOptions& options = {}) {
  return parse_record(name, std::move(bytes), options);
}
std::string said(const std::string& name, const std::string& bytes, const ReadOptions& options = {}) {
  try {
    (void)parse_record(name, bytes, options);
  } catch (const InputError& error) {
    const Diagnostic& first = error.diagnostics().all().front();
    EXPECT_FALSE(first.mend.empty());
    return fmt::format("HY{} {} {}", first.number, first.cause, first.mend);
  }
  return "read";
}

class Mat : public ::testing::TestWithParam<mat_ft> {};

/// Version 4, which Octave and Modelica still write, has no mark at its begin: five small numbers and a name.
std::string mat4_vector(const std::string& name, const std::vector<double>& values) {
  std::string bytes;
  for (const std::size_t part : {std::size_t{0}, values.size(), std::size_t{1}, std::size_t{0}, name.size() + 1}) {
    const auto word = static_cast<std::uint32_t>(part);
    bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
  }
  bytes.append(name.c_str(), name.size() + 1);
  bytes.append(reinterpret_cast<const char*>(values.data()), 8 * values.size());
  return bytes;
}

TEST(Mat4, IsReadByItsEnding) {
  const std::string bytes = mat4_vector("t", time_values) + mat4_vector("u", u_values);
  const Record record = read("log.mat", bytes);
  EXPECT_THAT(record.names(), ElementsAre("u"));
  EXPECT_THAT(record.column("u").values, ElementsAreArray(u_values));
  EXPECT_EQ(record.sample_time(), 0.001);
  EXPECT_THAT(said("log.mat", mat4_vector("Aclass", {1.0}) + mat4_vector("dataInfo", {1.0})),
              HasSubstr("outputFormat=\"csv\""));
  // Text of the same ending, as `save -ascii` writes it.
  EXPECT_THAT(read("log.mat", "0.000 1.0\n0.001 2.0\n0.002 3.0\n", {.time = "1"}).size(), 3U);
}

TEST_P(Mat, VectorsAreColumns) {
  const Record record = read("log.mat", MatFile(GetParam())
                                            .add(MatFile::vector("t", time_values))
                                            .add(MatFile::vector("u", u_values), MAT_COMPRESSION_ZLIB)
                                            .add(MatFile::vector("Ts", {0.001}))
                                            .add(MatFile::text("remark", "no signal"))
                                            .bytes());
  EXPECT_THAT(record.names(), ElementsAre("u"));
  EXPECT_THAT(record.column("u").values, ElementsAreArray(u_values));
  EXPECT_THAT(record.time(), ElementsAreArray(time_values));
  EXPECT_EQ(record.sample_time(), 0.001);
}

TEST_P(Mat, EveryKindOfNumberIsRead) {
  MatFile file(GetParam());
  file.add(MatFile::vector("t", time_values))
      .add(MatFile::typed<float>("single", MAT_C_SINGLE, MAT_T_SINGLE, {0.1F, 1.0F, -2.0F, 3.5F}))
      .add(MatFile::typed<std::int8_t>("i8", MAT_C_INT8, MAT_T_INT8, {-128, 127, 0, 1}))
      .add(MatFile::typed<std::uint8_t>("u8", MAT_C_UINT8, MAT_T_UINT8, {0, 255, 1, 2}))
      .add(MatFile::typed<std::int16_t>("i16", MAT_C_INT16, MAT_T_INT16, {-32768, 32767, 0, 1}))
      .add(MatFile::typed<std::uint16_t>("u16", MAT_C_UINT16, MAT_T_UINT16, {0, 65535, 1, 2}))
      .add(MatFile::typed<std::int32_t>("i32", MAT_C_INT32, MAT_T_INT32, {INT32_MIN, INT32_MAX, 0, 1}))
      .add(MatFile::typed<std::uint32_t>("u32", MAT_C_UINT32, MAT_T_UINT32, {0, UINT32_MAX, 1, 2}))
      .add(MatFile::typed<std::int64_t>("i64", MAT_C_INT64, MAT_T_INT64, {-(1LL << 52), 1LL << 52, 0, 1}))
      .add(MatFile::typed<std::uint8_t>("on", MAT_C_UINT8, MAT_T_UINT8, {0, 1, 1, 0}, MAT_F_LOGICAL));
  const Record record = read("log.mat", file.bytes());
  EXPECT_THAT(record.column("single").values, ElementsAre(static_cast<double>(0.1F), 1.0, -2.0, 3.5));
  EXPECT_THAT(record.column("i8").values, ElementsAre(-128, 127, 0, 1));
  EXPECT_THAT(record.column("u8").values, ElementsAre(0, 255, 1, 2));
  EXPECT_THAT(record.column("i16").values, ElementsAre(-32768, 32767, 0, 1));
  EXPECT_THAT(record.column("u16").values, ElementsAre(0, 65535, 1, 2));
  EXPECT_THAT(record.column("i32").values, ElementsAre(INT32_MIN, INT32_MAX, 0, 1));
  EXPECT_THAT(record.column("u32").values, ElementsAre(0, UINT32_MAX, 1, 2));
  EXPECT_THAT(record.column("i64").values, ElementsAre(-0x1p52, 0x1p52, 0, 1));
  EXPECT_THAT(record.column("on").values, ElementsAre(0, 1, 1, 0));
}

TEST_P(Mat, AMatrixGivesItsColumnsOrItsRows) {
  const std::vector<double> wide{1, 10, 2, 20, 3, 30, 4, 40};  // 2 × 4, column after column
  const Record record = read("log.mat", MatFile(GetParam())
                                            .add(MatFile::vector("time", time_values))
                                            .add(MatFile::matrix("Y", 4, 2, {1, 2, 3, 4, 5, 6, 7, 8}))
                                            .add(MatFile::matrix("W", 2, 4, wide))
                                            .bytes());
  EXPECT_THAT(record.names(), UnorderedElementsAre("Y_1", "Y_2", "W_1", "W_2"));
  EXPECT_THAT(record.column("Y_2").values, ElementsAre(5, 6, 7, 8));
  EXPECT_THAT(record.column("W_1").values, ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(record.column("W_2").values, ElementsAre(10, 20, 30, 40));
  ReadOptions options;
  options.time = "ans_1";  // To File of Simulink: the first row is the time
  const Record to_file = read("log.mat", MatFile(GetParam()).add(MatFile::matrix("ans", 2, 4, wide)).bytes(), options);
  EXPECT_EQ(to_file.sample_time(), 1.0);
  EXPECT_THAT(to_file.column("ans_2").values, ElementsAre(10, 20, 30, 40));
}

TEST_P(Mat, StructuresGiveTheirFields) {
  MatFile file(GetParam());
  file.add(MatFile::structure("log", {"t", "u"}, {MatFile::vector("t", time_values), MatFile::vector("u", u_values)}));
  const Record record = read("log.mat", file.bytes());
  EXPECT_THAT(record.names(), ElementsAre("u"));
  MatFile two(GetParam());
  two.add(MatFile::structure("a", {"time", "data"},
                             {MatFile::vector("time", time_values), MatFile::vector("data", u_values)}))
      .add(MatFile::structure("b", {"time", "data"},
                              {MatFile::vector("time", time_values), MatFile::vector("data", {4, 3, 2, 1})}));
  const Record merged = read("log.mat", two.bytes());
  EXPECT_THAT(merged.names(), ElementsAre("a", "b"));
  EXPECT_THAT(merged.column("b").values, ElementsAre(4, 3, 2, 1));
}

TEST_P(Mat, StructuresWithTimeOfSimulinkGiveTheirSignals) {
  matvar_t* const signals =
      MatFile::structure("signals", {"values", "label"},
                         {MatFile::vector("values", u_values), MatFile::text("label", "u"),
                          MatFile::matrix("values", 4, 2, {1, 2, 3, 4, 5, 6, 7, 8}), MatFile::text("label", "pos")});
  const Record record =
      read("log.mat",
           MatFile(GetParam())
               .add(MatFile::structure("simout", {"time", "signals"}, {MatFile::vector("time", time_values), signals}))
               .bytes());
  EXPECT_THAT(record.names(), ElementsAre("u", "pos_1", "pos_2"));
  EXPECT_THAT(record.column("pos_2").values, ElementsAre(5, 6, 7, 8));
  EXPECT_EQ(record.sample_time(), 0.001);
}

TEST_P(Mat, WhatIsNoSignalIsSaidToWhoAsksForIt) {
  std::size_t size[2] = {1, 2};
  const Record record = read("log.mat", MatFile(GetParam())
                                            .add(MatFile::vector("t", time_values))
                                            .add(MatFile::vector("u", u_values))
                                            .add(MatFile::vector("short", {1, 2, 3}))
                                            .add(Mat_VarCreate("cells", MAT_C_CELL, MAT_T_CELL, 2, size, nullptr, 0))
                                            .bytes());
  EXPECT_THAT(record.names(), ElementsAre("u"));
  for (const auto& [name, word] :
       {std::pair("short", "has 3 values, the record 4 rows"), {"cells", "is a cell array"}}) {
    try {
      (void)record.find(name);
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_THAT(error.diagnostics().all().front().cause, HasSubstr(word));
    }
  }
  EXPECT_THAT(said("log.mat", MatFile(GetParam()).add(MatFile::text("remark", "x")).bytes()),
              HasSubstr("HY513 The file holds no array of numbers"));
}

INSTANTIATE_TEST_SUITE_P(Versions, Mat, ::testing::Values(MAT_FT_MAT5, MAT_FT_MAT73),
                         [](const auto& one) { return one.param == MAT_FT_MAT5 ? "v5" : "v73"; });

TEST(Hdf5, DataSetsAreColumnsWithTheirUnits) {
  const std::int16_t counts[] = {1, -2, 3, 400};
  const double matrix[] = {1, 10, 2, 20, 3, 30, 4, 40};  // row after row
  Hdf5File file;
  file.add("/run/t", time_values, "s")
      .add("/run/drive/u", u_values, "mV")
      .add("/run/counts", H5T_NATIVE_INT16, counts, {4}, nullptr, H5T_STD_I16BE)
      .add("/run/Y", H5T_NATIVE_DOUBLE, matrix, {4, 2}, "um");
  const Record record = read("log.h5", file.bytes());
  EXPECT_THAT(record.names(), ElementsAre("Y_1", "Y_2", "counts", "drive.u"));
  EXPECT_THAT(record.column("drive.u").values, ElementsAreArray(u_values));
  EXPECT_EQ(record.column("drive.u").unit, "mV");
  EXPECT_EQ(record.column("Y_2").unit, "um");
  EXPECT_THAT(record.column("Y_2").values, ElementsAre(10, 20, 30, 40));
  EXPECT_THAT(record.column("counts").values, ElementsAre(1, -2, 3, 400));
  EXPECT_EQ(record.sample_time(), 0.001);
}

TEST(Hdf5, TablesGiveTheirMembers) {
  struct Row {
    double time;
    float u;
    int state;
  };
  const std::vector<Row> rows{{0.0, 0.5F, 1}, {0.5, 1.5F, 2}, {1.0, 2.5F, 3}};
  const hid_t type = H5Tcreate(H5T_COMPOUND, sizeof(Row));
  H5Tinsert(type, "time", offsetof(Row, time), H5T_NATIVE_DOUBLE);
  H5Tinsert(type, "u", offsetof(Row, u), H5T_NATIVE_FLOAT);
  H5Tinsert(type, "state", offsetof(Row, state), H5T_NATIVE_INT);
  const Record record = read("log.hdf5", Hdf5File().add("/log", type, rows.data(), {rows.size()}).bytes());
  H5Tclose(type);
  EXPECT_THAT(record.names(), ElementsAre("u", "state"));
  EXPECT_THAT(record.column("u").values, ElementsAre(0.5, 1.5, 2.5));
  EXPECT_EQ(record.sample_time(), 0.5);
}

TEST(Hdf5, WithoutATimeTheRateIsAskedFor) {
  const std::string bytes = Hdf5File().add("u", u_values).bytes();
  EXPECT_THAT(said("log.h5", bytes), HasSubstr("--rate"));
  ReadOptions options;
  options.rate = 250.0;
  EXPECT_EQ(read("log.h5", bytes, options).sample_time(), 0.004);
}

TEST(Wav, ChannelsAreColumnsAtTheRateOfTheFile) {
  const std::vector<double> frames{0.0, 0.5, 0.25, -0.5, -1.0, 0.125, 0.75, 0.0};
  const Record record = read("log.wav", wav_bytes(SF_FORMAT_DOUBLE, 44100, 2, frames));
  EXPECT_THAT(record.names(), ElementsAre("CH1", "CH2"));
  EXPECT_THAT(record.column("CH1").values, ElementsAre(0.0, 0.25, -1.0, 0.75));
  EXPECT_THAT(record.column("CH2").values, ElementsAre(0.5, -0.5, 0.125, 0.0));
  EXPECT_EQ(record.sample_time(), 1.0 / 44100.0);
  const Record whole = read("log.wav", wav_bytes(SF_FORMAT_PCM_16, 8000, 1, frames));
  EXPECT_THAT(whole.column("CH1").values[2], DoubleNear(0.25, 1.0 / 32768.0));
  EXPECT_THAT(whole.notes().front(), HasSubstr("parts of full scale"));
  ReadOptions options;
  options.begin = 0.00025;
  options.end = 0.0005;
  EXPECT_THAT(read("log.wav", wav_bytes(SF_FORMAT_DOUBLE, 8000, 1, frames), options).column("CH1").values,
              ElementsAre(0.25, -0.5));
}

TEST(Binary, AValueThatIsNotFiniteIsAFaultOfItsColumnAndItsRow) {
  const std::string bytes =
      Hdf5File().add("t", time_values).add("u", {1.0, 2.0, std::nan(""), 4.0}).add("y", u_values).bytes();
  const Record record = read("log.h5", bytes);
  EXPECT_THAT(record.names(), ElementsAre("y"));
  EXPECT_THAT(record.unreadable().front().fault.cause, HasSubstr("nan in row 3"));
  ReadOptions options;
  options.last_row = 2;
  EXPECT_THAT(read("log.h5", bytes, options).column("u").values, ElementsAre(1.0, 2.0));
}

TEST(Binary, NamesThatNoRecordCanHaveAreRefused) {
  for (const char* const name : {"u\xDD", "u\"", "u\n"}) {
    EXPECT_THAT(said("log.h5", Hdf5File().add("t", time_values).add(name, u_values).bytes()), HasSubstr("HY509"));
  }
}

/// Cut at every length, and with bytes of another value: a record, or a refusal with its mend.
void survives(const std::string& name, const std::string& bytes, std::size_t times) {
  std::mt19937 random(5);
  const auto below = [&](std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random); };
  std::size_t refused = 0;
  for (std::size_t k = 0; k < times; ++k) {
    std::string broken = bytes;
    if (k % 4 == 0) {
      broken.resize(below(bytes.size()));
    }
    for (std::size_t i = 0; i < 1 + k % 3 && !broken.empty(); ++i) {
      broken[below(broken.size())] = static_cast<char>(below(256));
    }
    refused += said(name, broken) != "read" ? 1 : 0;
  }
  EXPECT_GT(refused, times / 20);
}

TEST(Binary, BrokenFilesDoNoHarm) {
  for (const mat_ft version : {MAT_FT_MAT5, MAT_FT_MAT73}) {
    MatFile file(version);
    file.add(MatFile::vector("t", time_values), MAT_COMPRESSION_ZLIB)
        .add(MatFile::vector("u", u_values))
        .add(MatFile::structure("s", {"time", "data"},
                                {MatFile::vector("time", time_values), MatFile::vector("data", u_values)}));
    survives("log.mat", file.bytes(), 80);
  }
  survives("log.h5", Hdf5File().add("/a/t", time_values, "s").add("/a/u", u_values, "V").bytes(), 80);
  survives("log.wav", wav_bytes(SF_FORMAT_PCM_16, 8000, 2, std::vector<double>(64, 0.25)), 80);
}

}  // namespace
}  // namespace hysteron::records::test
