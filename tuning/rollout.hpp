// Rollouts of an output-error problem: outputs over all records, residuals, and their Jacobian by dual numbers.
// Internal to output_error.cpp.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "tuning/machine_dual.hpp"
#include "tuning/output_error.hpp"
#include "tuning/unreached.hpp"

namespace hysteron::detail {

/// The signals of nodes that stand still from rollout to rollout, and the machines of the others.
struct Kept {
  Kept(const Program& whole, double sample_time, std::vector<bool> the_still, std::size_t record_count)
      : still(std::move(the_still)),
        rest(without_nodes(whole, still)),
        machines(rest.program, sample_time),
        records(record_count) {}
  struct OfRecord {
    bool filled = false;
    Eigen::VectorXd x{};           ///< at which they were kept
    std::vector<double> values{};  ///< of each step: what is given, wire by wire
  };
  std::vector<bool> still;
  WithoutNodes rest;
  Machines machines;
  std::vector<OfRecord> records;
};

/// The unknowns are the parameters, those of a single record among them, then the initial states of the first record,
/// at its start and at each of its restarts, of the second, …
class Rollout {
 public:
  explicit Rollout(const OutputErrorProblem& problem);

  [[nodiscard]] Eigen::Index residual_count() const { return rows_; }
  [[nodiscard]] Eigen::Index unknowns() const;

  /// Whose value an unknown behind the parameters is: of a state, at a start of a record: 0, then its restarts.
  struct StateColumn {
    std::size_t experiment = 0;
    std::size_t start = 0;
    std::size_t state = 0;
  };
  [[nodiscard]] std::vector<StateColumn> state_columns() const;

  /// Divisors of the residuals, by measured output.
  void set_scales(std::vector<double> scales) { scales_ = std::move(scales); }
  [[nodiscard]] const std::vector<double>& scales() const { return scales_; }

  /// (model − measured)/scale in train, output by output; false where one is not finite. What other blocks still
  /// remember of the states before a restart counts, in the Jacobian, for those after it.
  bool residuals(const Eigen::VectorXd& x, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian);

  /// Whether several points can be run at once: on a processor with registers of 256 bits, of a program
  /// without an FMU.
  [[nodiscard]] bool can_run_side_by_side() const { return has_registers_of_four() && !reach_.has_fmu(); }
  /// As residuals() without derivatives, to the bit, for lane_count points at the most at once. A point that has no
  /// value gets no residuals. Only where it can be done.
  [[nodiscard]] std::vector<std::optional<Eigen::VectorXd>> residuals_side_by_side(
      std::span<const Eigen::VectorXd> points);

  /// Points of which residuals() without derivatives are likely to be asked for next, before those that were foreseen
  /// already: where it can be done, they are then run side by side. Some of the residuals are kept: who asks once more
  /// gets them without a run.
  void foresee(std::vector<Eigen::VectorXd> points);
  void forget_foreseen() { foreseen_.clear(); }

  /// The measured outputs of one record over all its steps.
  [[nodiscard]] std::vector<Signal> outputs(const Eigen::VectorXd& x, std::size_t experiment);

  /// The values that the states have by themselves with these parameters, in the order of the unknowns: after the reset
  /// of each record, and when it comes to its restarts.
  [[nodiscard]] std::vector<double> own_states(const Eigen::VectorXd& parameters);

 private:
  struct Foreseen {
    Eigen::VectorXd x{};
    bool done = false;
    bool asked = false;                          ///< for, and may be once more
    std::optional<Eigen::VectorXd> residuals{};  ///< once it is done; none where it has no value
  };
  /// A point that was foreseen with enough others, with its residuals; null: it is to be run by itself.
  Foreseen* among_foreseen(const Eigen::VectorXd& x);
  /// Where too many residuals are kept: without those that were asked for first.
  void keep_some();
  bool all_residuals(const Eigen::VectorXd& x, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian);
  bool plain_pass(const Eigen::VectorXd& x, std::size_t experiment, Eigen::VectorXd& residuals);
  bool keeping_pass(const Eigen::VectorXd& x, std::size_t experiment, Kept& kept, Eigen::VectorXd& residuals);
  bool derivative_passes(const Eigen::VectorXd& x, std::size_t experiment, std::span<const Eigen::Index> columns,
                         Eigen::VectorXd& residuals, Eigen::MatrixXd& jacobian);
  /// What of a record a pass plays instead of running it, and what it keeps for later ones; each may be null.
  struct Replay {
    Kept* played = nullptr;
    Kept* kept = nullptr;
  };
  /// One pass over one record: S carries the derivatives by the unknowns in `columns`.
  template <class S>
  bool pass(Machine<S>& machine, const Eigen::VectorXd& x, std::size_t experiment,
            std::span<const Eigen::Index> columns, const Replay& replay, Eigen::VectorXd& residuals,
            Eigen::MatrixXd* jacobian);
  /// The unknowns that act in a record, states of all its starts among them.
  [[nodiscard]] std::vector<Eigen::Index> columns_of(std::size_t experiment) const;
  /// What is played of a record in which the signals that no unknown reaches are kept; else those are kept now.
  Replay of_unreached(std::size_t experiment);
  /// The same for a point of a grid: what its own changes do not reach is kept as well.
  Replay of_grid(const Eigen::VectorXd& x, std::size_t experiment);
  /// Makes ready to keep a record without the nodes that are `still`; what is kept of other records stays where these
  /// are the same nodes.
  void make_ready(std::unique_ptr<Kept>& kept, std::vector<bool> still, std::size_t experiment) const;
  /// Whether what is kept of a record is what a rollout at x would give.
  [[nodiscard]] bool holds(const Kept& kept, const Eigen::VectorXd& x, std::size_t experiment) const;
  /// What is played into points that are run side by side: what none of the columns reaches in which they differ. It is
  /// run with the first of them where it is not kept yet, whose residuals then stand; null: there is nothing.
  Kept* played_side_by_side(std::span<const Eigen::VectorXd> points, std::size_t experiment,
                            std::vector<std::optional<Eigen::VectorXd>>& residuals);
  void pass_side_by_side(Machine<Lanes>& machine, std::span<const Eigen::VectorXd> points, std::size_t experiment,
                         const Kept* played, std::vector<std::optional<Eigen::VectorXd>>& residuals) const;

  // The unknowns come by of(column, seed): the value of the unknown in `column`, as S; its derivative is that of the
  // column `seed`, which is where it stands at start 0.
  template <class S, class Of>
  void prepare(Machine<S>& machine, std::size_t experiment, const Of& of) const;
  /// The states at a start of a record: 0, then its restarts.
  template <class S, class Of>
  void load_states(Machine<S>& machine, std::size_t experiment, std::size_t start, const Of& of) const;
  /// Whether a record restarts at this step; then `start` is counted on and its states are loaded.
  template <class S, class Of>
  bool restarts(Machine<S>& machine, std::size_t experiment, std::size_t step, std::size_t& start, const Of& of) const;
  /// The parameters that act in a record.
  template <class S, class Of>
  void set_parameters(Machine<S>& machine, std::size_t experiment, const Of& of) const;
  [[nodiscard]] Eigen::Index state_column(std::size_t experiment, std::size_t start, std::size_t state) const;
  /// Of what is in this column at start 0.
  [[nodiscard]] Eigen::Index column_at(Eigen::Index column, std::size_t start) const;

  const OutputErrorProblem& problem_;
  std::vector<double> scales_{};
  Eigen::Index rows_ = 0;
  std::vector<std::vector<Eigen::Index>> first_row_{};  ///< of the residuals, by record and output
  std::vector<Eigen::Index> first_state_{};             ///< column of the first state, by record; at the end their sum
  Machines whole_;
  Reach reach_;
  std::unique_ptr<Kept> unreached_{};  ///< by any unknown; null: there is nothing to keep
  std::unique_ptr<Kept> of_grid_{};    ///< while points of a grid are tried
  std::unique_ptr<Kept> beside_{};     ///< while points are run side by side
  std::vector<Foreseen> foreseen_{};
  std::vector<Eigen::VectorXd> last_x_{};  ///< by record
  bool is_grid_ = true;                    ///< no derivative has been asked for yet
};

}  // namespace hysteron::detail
