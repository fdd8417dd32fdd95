#include "diagnosis/evidence/gap_kinds.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <utility>

#include "diagnosis/evidence/driver_lines.hpp"
#include "diagnosis/evidence/roles.hpp"
#include "diagnosis/model/filters.hpp"
#include "diagnosis/model/parallel.hpp"
#include "diagnosis/noise/spectrum.hpp"

namespace hysteron::diagnosis {
namespace {

using KindSignals = std::array<std::vector<RecordSignals>, gap_kinds.size()>;

std::vector<RecordSignals>& of(KindSignals& signals, GapKind kind) {
  return signals[static_cast<std::size_t>(kind)];
}

RecordSignals mapped(const RecordSignals& a, const std::function<double(double)>& function) {
  RecordSignals result = a;
  for (Signal& one : result) {
    std::ranges::transform(one, one.begin(), function);
  }
  return result;
}

RecordSignals product(const RecordSignals& a, const RecordSignals& b) {
  RecordSignals result = a;
  for (std::size_t e = 0; e < a.size(); ++e) {
    std::ranges::transform(a[e], b[e], result[e].begin(), std::multiplies<>());
  }
  return result;
}

/// From −1 to 1 over its usual range; empty where it rests.
RecordSignals normalised(const RecordSignals& values, double sample_time) {
  const Extent extent = extent_of(values, sample_time);
  const double half = 0.5 * (extent.usual > 0.0 ? extent.usual : extent.range());
  const double middle = 0.5 * (extent.low + extent.high);
  return half > 0.0 ? mapped(values, [=](double x) { return (x - middle) / half; }) : RecordSignals();
}

/// Of a rate: in its largest usual size, with its zero kept. Empty where it is none.
RecordSignals sized(const RecordSignals& rates) {
  std::vector<double> sizes;
  for (const Signal& one : rates) {
    std::ranges::transform(one, std::back_inserter(sizes), [](double v) { return std::abs(v); });
  }
  if (sizes.empty()) {
    return {};
  }
  const auto high = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() - 1 - sizes.size() / 50);
  std::ranges::nth_element(sizes, high);
  const double size = *high;
  return size > 0.0 ? mapped(rates, [=](double v) { return v / size; }) : RecordSignals();
}

RecordSignals direction_of(const RecordSignals& sized_rates) {
  constexpr double sharpness = 20.0;
  return mapped(sized_rates, [](double v) { return std::tanh(sharpness * v); });
}

RecordSignals played(RecordSignals values, double width) {
  for (Signal& one : values) {
    one = play(one, width);
  }
  return values;
}

/// The share of each record that has passed, from 0 to 1.
RecordSignals progress_of(const RecordSignals& like) {
  RecordSignals result = like;
  for (Signal& one : result) {
    for (std::size_t k = 0; k < one.size(); ++k) {
      one[k] = static_cast<double>(k) / static_cast<double>(one.size());
    }
  }
  return result;
}

/// A first-order lag by so many samples.
RecordSignals slowed(RecordSignals values, double samples) {
  for (Signal& one : values) {
    one = lagged(one, 1.0 + samples);
  }
  return values;
}

void add_curves(const RecordSignals& z, std::vector<RecordSignals>& list) {
  list.push_back(mapped(z, [](double x) { return x * x; }));
  list.push_back(mapped(z, [](double x) { return x * x * x; }));
  list.push_back(mapped(z, [](double x) { return std::abs(x); }));
  list.push_back(mapped(z, [](double x) { return x * std::abs(x); }));
  list.push_back(mapped(z, [](double x) { return std::max(0.0, x - 0.5); }));
  list.push_back(mapped(z, [](double x) { return std::max(0.0, -x - 0.5); }));
}

/// What may be added on the edge of a place.
KindSignals signals_at(const Space::Place& place, const std::vector<DriverSignal>& drivers, double sample_time) {
  KindSignals result;
  const RecordSignals z = normalised(place.carried, sample_time);
  if (z.empty()) {
    return result;
  }
  const RecordSignals one = mapped(z, [](double) { return 1.0; });
  const RecordSignals progress = progress_of(z);
  of(result, GapKind::Static).push_back(one);
  add_curves(z, of(result, GapKind::Static));
  for (const double width : {0.05, 0.15, 0.4, 0.8}) {
    of(result, GapKind::Memory).push_back(played(z, width));
  }
  const auto add_rate = [&](const RecordSignals& rate) {
    const RecordSignals direction = direction_of(rate);
    of(result, GapKind::Memory).push_back(direction);
    of(result, GapKind::Memory).push_back(product(direction, z));
    of(result, GapKind::Static).push_back(mapped(rate, [](double v) { return std::abs(v); }));
    of(result, GapKind::Static).push_back(mapped(rate, [](double v) { return v * std::abs(v); }));
    of(result, GapKind::Linear).push_back(rate);
  };
  if (const RecordSignals rate = sized(rates_of(place.carried, sample_time).values); !rate.empty()) {
    add_rate(rate);
  }
  for (const DriverSignal& driver : drivers) {
    if (driver.source == DriverSignal::Source::Column) {
      const RecordSignals c =
          driver.is_rate || driver.is_follower ? RecordSignals() : normalised(driver.values, sample_time);
      if (!c.empty()) {
        of(result, GapKind::Columns).push_back(c);
        of(result, GapKind::Columns).push_back(product(c, z));
        for (const double part : {0.01, 0.1}) {
          of(result, GapKind::Columns).push_back(slowed(c, part * static_cast<double>(c.front().size())));
        }
      }
    } else if (!place.is_port && driver.name != place.edge.name) {
      const bool moves = driver.is_rate || quantity_of(driver.unit).velocity;
      const RecordSignals d = moves ? sized(driver.values) : normalised(driver.values, sample_time);
      if (!d.empty() && moves) {
        add_rate(d);
      } else if (!d.empty()) {
        of(result, GapKind::Linear).push_back(d);
      }
    }
  }
  std::vector<RecordSignals>& courses = of(result, GapKind::Time);
  courses.push_back(progress);
  courses.push_back(mapped(progress, [](double t) { return t * t; }));
  // Slower than a stretch that is held out, which they have to bridge.
  for (int half_waves = 1; half_waves <= 8; ++half_waves) {
    courses.push_back(mapped(progress, [=](double t) { return std::cos(std::numbers::pi * half_waves * t); }));
  }
  for (const double part : {0.01, 0.05, 0.2}) {
    courses.push_back(mapped(progress, [=](double t) { return std::exp(-t / part); }));
  }
  courses.push_back(product(progress, z));
  courses.push_back(product(courses[1], z));
  return result;
}

/// The impulse response of a linear filter, by steps that grow with the delay: a mean of the input over each.
void add_delayed(const RecordSignals& input, std::vector<RecordSignals>& list) {
  constexpr std::size_t single = 24;
  constexpr double growth = 1.2;
  std::size_t longest = 0;
  for (const Signal& one : input) {
    longest = std::max(longest, one.size() / 10);
  }
  for (std::size_t first = 0; first < longest;) {
    const std::size_t width =
        first < single ? 1 : static_cast<std::size_t>(std::max(1.0, (growth - 1.0) * static_cast<double>(first)));
    RecordSignals delayed = input;
    for (std::size_t e = 0; e < input.size(); ++e) {
      double sum = 0.0;
      const auto at = [&](std::ptrdiff_t k) {
        return input[e][static_cast<std::size_t>(std::max<std::ptrdiff_t>(k, 0))];
      };
      for (std::size_t j = 0; j < width; ++j) {
        sum += at(-static_cast<std::ptrdiff_t>(first + j));
      }
      for (std::size_t k = 0; k < input[e].size(); ++k) {
        delayed[e][k] = sum / static_cast<double>(width);
        const auto next = static_cast<std::ptrdiff_t>(k + 1);
        sum += at(next - static_cast<std::ptrdiff_t>(first)) - at(next - static_cast<std::ptrdiff_t>(first + width));
      }
    }
    list.push_back(std::move(delayed));
    first += width;
  }
}

/// Both parts of a damped oscillation that the input excites.
void add_resonator(const RecordSignals& input, double frequency, double damping, double sample_time,
                   std::vector<RecordSignals>& list) {
  const double angle = 2.0 * std::numbers::pi * frequency * sample_time;
  const std::complex<double> pole = std::exp(std::complex<double>(-damping * angle, angle));
  RecordSignals real = input;
  RecordSignals imaginary = input;
  for (std::size_t e = 0; e < input.size(); ++e) {
    std::complex<double> state = 0.0;
    for (std::size_t k = 0; k < input[e].size(); ++k) {
      state = pole * state + (input[e][k] - input[e].front());
      real[e][k] = state.real();
      imaginary[e][k] = state.imag();
    }
  }
  list.push_back(std::move(real));
  list.push_back(std::move(imaginary));
}

/// A line in each record, of its own phase: between two records any time may have passed.
void add_line(const RecordSignals& like, const std::function<double(std::size_t, std::size_t)>& angle, bool one_phase,
              std::vector<RecordSignals>& list) {
  for (std::size_t own = 0; own < (one_phase ? 1 : like.size()); ++own) {
    RecordSignals sine = like;
    RecordSignals cosine = like;
    for (std::size_t e = 0; e < like.size(); ++e) {
      const bool counts = one_phase || e == own;
      for (std::size_t k = 0; k < like[e].size(); ++k) {
        sine[e][k] = counts ? std::sin(angle(e, k)) : 0.0;
        cosine[e][k] = counts ? std::cos(angle(e, k)) : 0.0;
      }
    }
    list.push_back(std::move(sine));
    list.push_back(std::move(cosine));
  }
}

/// What acts at the output itself, whatever the diagram does.
KindSignals signals_of_output(const Task& task, const Space& space, const VectorXd& residuals) {
  constexpr std::size_t lines = 3;
  constexpr std::size_t candidates = 8;
  const double sample_time = task.records.front().sample_time();
  const std::vector<DriverSignal>& drivers = space.drivers();
  KindSignals result;
  const auto longest =
      std::ranges::max_element(task.records, {}, [](const records::Record& one) { return one.size(); });
  Index first = 0;
  for (auto one = task.records.begin(); one != longest; ++one) {
    first += static_cast<Index>(one->size());
  }
  std::vector<double> frequencies =
      Periodogram(residuals.segment(first, static_cast<Index>(longest->size())), sample_time)
          .strongest_lines(candidates);
  const std::vector<double> resonances(frequencies.begin(),
                                       frequencies.begin() + std::min<std::ptrdiff_t>(lines, std::ssize(frequencies)));
  bar_lines_of(drivers, sample_time, frequencies);
  frequencies.resize(std::min(frequencies.size(), lines));
  RecordSignals like;
  for (const records::Record& record : task.records) {
    like.emplace_back(record.size(), 0.0);
  }
  for (const double frequency : frequencies) {
    const double angle = 2.0 * std::numbers::pi * frequency * sample_time;
    add_line(
        like, [=](std::size_t, std::size_t k) { return angle * static_cast<double>(k); }, false,
        of(result, GapKind::Periodic));
  }
  for (const DriverSignal& driver : drivers) {
    if (driver.source == DriverSignal::Source::Input && !driver.is_rate && driver.extent.range() > 0.0) {
      add_delayed(driver.values, of(result, GapKind::Linear));
      for (const double frequency : resonances) {
        for (const double damping : {0.01, 0.1}) {
          add_resonator(driver.values, frequency, damping, sample_time, of(result, GapKind::Linear));
        }
      }
    }
    if (!driver.is_rate && quantity_of(driver.unit).position && driver.source != DriverSignal::Source::Column) {
      for (const double period : strongest_periods(residuals, driver.values, lines)) {
        add_line(
            driver.values,
            [&, period](std::size_t e, std::size_t k) { return 2.0 * std::numbers::pi * driver.values[e][k] / period; },
            true, of(result, GapKind::Periodic));
      }
    }
  }
  return result;
}

void append(MatrixXd& columns, const MatrixXd& further) {
  const Index before = columns.cols();
  columns.conservativeResize(further.rows(), before + further.cols());
  columns.rightCols(further.cols()) = further;
}

}  // namespace

std::array<MatrixXd, gap_kinds.size()> gap_bases(const Task& task, const Space& space, std::size_t output,
                                                 const Blocks& rows, unsigned threads) {
  const Index samples = space.residuals().size() / static_cast<Index>(space.outputs());
  const Index first = static_cast<Index>(output) * samples;
  std::array<MatrixXd, gap_kinds.size()> result;
  std::ranges::fill(result, MatrixXd(rows.rows(), 0));
  const std::vector<Space::Place>& places = space.places();
  std::vector<std::array<MatrixXd, gap_kinds.size()>> found(places.size());
  const double sample_time = task.records.front().sample_time();
  in_parallel(places.size(), threads, [&](std::size_t i) {
    const KindSignals signals = signals_at(places[i], space.drivers(), sample_time);
    for (std::size_t kind = 0; kind < signals.size(); ++kind) {
      const MatrixXd changed = signals[kind].empty() ? MatrixXd() : space.of(i, signals[kind]);
      if (changed.size() > 0) {
        found[i][kind] = rows.thinned(changed.middleRows(first, samples));
      }
    }
  });
  for (const auto& one : found) {
    for (std::size_t kind = 0; kind < one.size(); ++kind) {
      if (one[kind].size() > 0) {
        append(result[kind], one[kind]);
      }
    }
  }
  const KindSignals direct = signals_of_output(task, space, space.residuals().segment(first, samples));
  for (std::size_t kind = 0; kind < direct.size(); ++kind) {
    MatrixXd stacked(samples, std::ssize(direct[kind]));
    for (Index j = 0; j < stacked.cols(); ++j) {
      Index row = 0;
      for (const Signal& one : direct[kind][static_cast<std::size_t>(j)]) {
        stacked.col(j).segment(row, std::ssize(one)) = Eigen::Map<const VectorXd>(one.data(), std::ssize(one));
        row += std::ssize(one);
      }
    }
    append(result[kind], rows.thinned(stacked));
  }
  return result;
}

}  // namespace hysteron::diagnosis
