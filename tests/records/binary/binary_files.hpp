// Binary files for the tests of their readers, written by the libraries that define them.
#pragma once

#include <hdf5.h>
#include <matio.h>
#include <sndfile.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "support/text_file.hpp"

namespace hysteron::records::test {

/// A file in a folder that goes with it.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name) {
    std::string pattern = (std::filesystem::temp_directory_path() / "hysteron-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
    path_ = (folder_ / name).string();
  }
  ~TemporaryFile() { std::filesystem::remove_all(folder_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  TemporaryFile(TemporaryFile&&) = delete;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  [[nodiscard]] const char* path() const { return path_.c_str(); }
  [[nodiscard]] std::string bytes() const { return read_text_file(path_); }

 private:
  std::filesystem::path folder_;
  std::string path_;
};

/// Variables of MATLAB, written as they are added.
class MatFile {
 public:
  explicit MatFile(mat_ft version) : file_("log.mat"), mat_(Mat_CreateVer(file_.path(), nullptr, version)) {}

  static matvar_t* matrix(const char* name, std::size_t rows, std::size_t columns, std::vector<double> values) {
    std::size_t size[2] = {rows, columns};
    return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size, values.data(), 0);
  }
  static matvar_t* vector(const char* name, const std::vector<double>& values) {
    return matrix(name, values.size(), 1, values);
  }
  template <class T>
  static matvar_t* typed(const char* name, matio_classes kind, matio_types type, std::vector<T> values, int flags = 0) {
    std::size_t size[2] = {1, values.size()};
    return Mat_VarCreate(name, kind, type, 2, size, values.data(), flags);
  }
  static matvar_t* text(const char* name, std::string value) {
    std::size_t size[2] = {1, value.size()};
    return Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UINT8, 2, size, value.data(), 0);
  }
  /// Elements × fields, field after field within an element.
  static matvar_t* structure(const char* name, std::vector<const char*> fields, const std::vector<matvar_t*>& values) {
    std::size_t size[2] = {1, values.size() / fields.size()};
    matvar_t* const made = Mat_VarCreateStruct(name, 2, size, fields.data(), static_cast<unsigned>(fields.size()));
    for (std::size_t i = 0; i < values.size(); ++i) {
      Mat_VarSetStructFieldByName(made, fields[i % fields.size()], i / fields.size(), values[i]);
    }
    return made;
  }

  MatFile& add(matvar_t* variable, matio_compression packed = MAT_COMPRESSION_NONE) {
    Mat_VarWrite(mat_, variable, packed);
    Mat_VarFree(variable);
    return *this;
  }
  [[nodiscard]] std::string bytes() {
    Mat_Close(mat_);
    return file_.bytes();
  }

 private:
  TemporaryFile file_;
  mat_t* mat_;
};

/// Data sets of HDF5, by paths.
class Hdf5File {
 public:
  Hdf5File() : file_("log.h5"), id_(H5Fcreate(file_.path(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {}

  Hdf5File& add(const char* path, hid_t type, const void* data, std::vector<hsize_t> size, const char* unit = nullptr,
                hid_t stored = -1) {
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    const hid_t space = H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr);
    const hid_t set = H5Dcreate2(id_, path, stored < 0 ? type : stored, space, links, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    if (unit != nullptr) {
      const hid_t text = H5Tcopy(H5T_C_S1);
      H5Tset_size(text, std::string_view(unit).size() + 1);
      const hid_t one = H5Screate(H5S_SCALAR);
      const hid_t attribute = H5Acreate2(set, "units", text, one, H5P_DEFAULT, H5P_DEFAULT);
      H5Awrite(attribute, text, unit);
      H5Aclose(attribute);
      H5Sclose(one);
      H5Tclose(text);
    }
    H5Dclose(set);
    H5Sclose(space);
    H5Pclose(links);
    return *this;
  }
  Hdf5File& add(const char* path, const std::vector<double>& values, const char* unit = nullptr) {
    return add(path, H5T_NATIVE_DOUBLE, values.data(), {values.size()}, unit);
  }
  [[nodiscard]] std::string bytes() {
    H5Fclose(id_);
    return file_.bytes();
  }

 private:
  TemporaryFile file_;
  hid_t id_;
};

/// A sound file: frames of all channels, one after the other.
inline std::string wav_bytes(int format, int rate, int channels, const std::vector<double>& frames) {
  const TemporaryFile file("log.wav");
  SF_INFO info{};
  info.samplerate = rate;
  info.channels = channels;
  info.format = SF_FORMAT_WAV | format;
  SNDFILE* const sound = sf_open(file.path(), SFM_WRITE, &info);
  sf_writef_double(sound, frames.data(), static_cast<sf_count_t>(frames.size()) / channels);
  sf_close(sound);
  return file.bytes();
}

}  // namespace hysteron::records::test
