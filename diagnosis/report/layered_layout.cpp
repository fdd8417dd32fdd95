#include "diagnosis/report/layered_layout.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

namespace hysteron::diagnosis::report {
namespace {

constexpr double column_gap = 74.0;  ///< holds "> 99.9 %", which stands over a wire
constexpr double box_gap = 22.0;
constexpr double lane_gap = 14.0;  ///< between curves that pass boxes
constexpr double margin = 14.0;
constexpr double turn = 24.0;  ///< how far a curve that turns back reaches out
constexpr int order_sweeps = 24;
constexpr int height_sweeps = 40;
constexpr std::size_t none = static_cast<std::size_t>(-1);

/// A box, or a place in a column where a curve passes.
struct Item {
  std::size_t box = none;
  std::size_t column = 0;
  double height = 0.0;
  double y = 0.0;  ///< of the top
};

/// Between items in neighbouring columns.
struct Link {
  std::size_t from = 0;
  double from_height = 0.0;
  std::size_t to = 0;
  double to_height = 0.0;
};

class Layering {
 public:
  Layering(const std::vector<LayoutBox>& boxes, const std::vector<LayoutEdge>& edges)
      : boxes_(boxes), edges_(edges), backward_(edges.size(), false), column_(boxes.size(), 0), ways_(edges.size()) {}

  Layout run() {
    cut_cycles();
    assign_columns();
    make_items();
    order_columns();
    assign_heights();
    return drawn();
  }

 private:
  /// Whether a box leads back to itself over boxes that are not placed yet.
  [[nodiscard]] bool on_cycle(std::size_t start, const std::vector<bool>& placed) const {
    std::vector<bool> seen(boxes_.size(), false);
    std::vector<std::size_t> open{start};
    while (!open.empty()) {
      const std::size_t box = open.back();
      open.pop_back();
      for (const LayoutEdge& edge : edges_) {
        if (edge.from == box && edge.to == start) {
          return true;
        }
        if (edge.from == box && !placed[edge.to] && !seen[edge.to]) {
          seen[edge.to] = true;
          open.push_back(edge.to);
        }
      }
    }
    return false;
  }

  /// Boxes in the order of the signals. Where only cycles are left, the box that waits for the fewest of its inputs
  /// comes next, and of those the one nearest to the inputs of the diagram, as the summing point of a loop is. What it
  /// still waits for runs backward.
  void cut_cycles() {
    std::vector<bool> placed(boxes_.size(), false);
    std::vector<int> depth(boxes_.size(), 0);
    while (order_.size() < boxes_.size()) {
      std::size_t best = none;
      std::tuple<bool, int, int> best_rank{};
      bool ready = false;
      for (std::size_t box = 0; box < boxes_.size() && !ready; ++box) {
        if (placed[box]) {
          continue;
        }
        int waiting = 0;
        int nearest = std::numeric_limits<int>::max();
        for (const LayoutEdge& edge : edges_) {
          waiting += edge.to == box && !placed[edge.from] ? 1 : 0;
          nearest = edge.to == box && placed[edge.from] ? std::min(nearest, depth[edge.from]) : nearest;
        }
        ready = waiting == 0;
        const bool unfed = nearest == std::numeric_limits<int>::max();
        const std::tuple rank{unfed, waiting, nearest};
        if (ready || ((best == none || rank < best_rank) && on_cycle(box, placed))) {
          best = box;
          best_rank = rank;
          depth[best] = unfed ? 0 : nearest + 1;
        }
      }
      for (std::size_t e = 0; e < edges_.size(); ++e) {
        backward_[e] = backward_[e] || (edges_[e].to == best && !placed[edges_[e].from]);
      }
      placed[best] = true;
      order_.push_back(best);
    }
  }

  void assign_columns() {
    const bool inputs = std::any_of(boxes_.begin(), boxes_.end(), [](const auto& b) { return b.side == Side::Left; });
    std::size_t last = 0;
    for (const std::size_t box : order_) {
      std::size_t column = inputs && boxes_[box].side != Side::Left ? 1 : 0;
      for (std::size_t e = 0; e < edges_.size(); ++e) {
        if (edges_[e].to == box && !backward_[e]) {
          column = std::max(column, column_[edges_[e].from] + 1);
        }
      }
      column_[box] = column;
      last = std::max(last, column);
    }
    for (auto box = order_.rbegin(); box != order_.rend(); ++box) {
      if (boxes_[*box].side == Side::Right) {
        column_[*box] = last;
      } else if (boxes_[*box].side == Side::Any) {
        pull_right(*box);
      }
    }
    columns_.resize(last + 1);
  }

  /// A box without inputs stands right before the first one that reads it.
  void pull_right(std::size_t box) {
    std::size_t first_reader = none;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (edges_[e].to == box && !backward_[e]) {
        return;
      }
      if (edges_[e].from == box && !backward_[e]) {
        first_reader = std::min(first_reader, column_[edges_[e].to]);
      }
    }
    if (first_reader != none) {
      column_[box] = first_reader - 1;
    }
  }

  std::size_t add_item(Item item) {
    items_.push_back(item);
    return items_.size() - 1;
  }

  void make_items() {
    for (std::size_t box = 0; box < boxes_.size(); ++box) {
      const std::size_t item = add_item({.box = box, .column = column_[box], .height = boxes_[box].height});
      columns_[column_[box]].push_back(item);
    }
    std::map<std::tuple<std::size_t, double, std::size_t>, std::size_t> shared;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const LayoutEdge& edge = edges_[e];
      if (backward_[e]) {
        continue;
      }
      std::size_t at = edge.from;
      double height = edge.from_height;
      for (std::size_t column = column_[edge.from] + 1; column < column_[edge.to]; ++column) {
        const auto [found, is_new] = shared.try_emplace({edge.from, edge.from_height, column}, items_.size());
        if (is_new) {
          columns_[column].push_back(add_item({.column = column}));
          links_.push_back({at, height, found->second, 0.0});
        }
        at = found->second;
        height = 0.0;
        ways_[e].push_back(at);
      }
      links_.push_back({at, height, edge.to, edge.to_height});
    }
  }

  /// The mean position of what an item is linked to on one side; its own where there is nothing.
  [[nodiscard]] double barycentre(std::size_t item, bool from_left, const std::vector<double>& position) const {
    double sum = 0.0;
    int count = 0;
    for (const Link& link : links_) {
      if ((from_left ? link.to : link.from) == item) {
        const std::size_t other = from_left ? link.from : link.to;
        const double height = from_left ? link.from_height : link.to_height;
        sum += position[other] + (items_[other].height > 0.0 ? height / items_[other].height - 0.5 : 0.0);
        ++count;
      }
    }
    return count == 0 ? position[item] : sum / count;
  }

  [[nodiscard]] std::vector<double> positions() const {
    std::vector<double> position(items_.size(), 0.0);
    for (const auto& column : columns_) {
      for (std::size_t i = 0; i < column.size(); ++i) {
        position[column[i]] = static_cast<double>(i);
      }
    }
    return position;
  }

  [[nodiscard]] std::size_t crossings() const {
    const std::vector<double> position = positions();
    const auto end = [&](std::size_t item, double height) {
      return position[item] + (items_[item].height > 0.0 ? height / items_[item].height - 0.5 : 0.0);
    };
    std::size_t count = 0;
    for (std::size_t a = 0; a < links_.size(); ++a) {
      for (std::size_t b = a + 1; b < links_.size(); ++b) {
        if (items_[links_[a].from].column == items_[links_[b].from].column) {
          const double left = end(links_[a].from, links_[a].from_height) - end(links_[b].from, links_[b].from_height);
          const double right = end(links_[a].to, links_[a].to_height) - end(links_[b].to, links_[b].to_height);
          count += left * right < 0.0 ? 1 : 0;
        }
      }
    }
    return count;
  }

  void order_columns() {
    auto best = columns_;
    std::size_t fewest = crossings();
    for (int sweep = 0; sweep < order_sweeps && fewest > 0; ++sweep) {
      const bool from_left = sweep % 2 == 0;
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        auto& column = columns_[from_left ? i : columns_.size() - 1 - i];
        const std::vector<double> position = positions();
        std::vector<double> wish(items_.size(), 0.0);
        for (const std::size_t item : column) {
          wish[item] = barycentre(item, from_left, position);
        }
        std::stable_sort(column.begin(), column.end(), [&](std::size_t a, std::size_t b) { return wish[a] < wish[b]; });
      }
      if (const std::size_t count = crossings(); count < fewest) {
        fewest = count;
        best = columns_;
      }
    }
    columns_ = best;
  }

  [[nodiscard]] double distance(std::size_t above, std::size_t below) const {
    const bool boxes = items_[above].box != none && items_[below].box != none;
    return items_[above].height + (boxes ? box_gap : lane_gap);
  }

  /// Heights nearest to the wishes in least squares, with the distances kept: neighbours in conflict are pooled
  /// (isotonic regression).
  void place(const std::vector<std::size_t>& column, const std::vector<double>& wish) {
    struct Pool {
      double mean;
      double weight;
      std::size_t count;
    };
    std::vector<Pool> pools;
    std::vector<double> shift(column.size(), 0.0);
    for (std::size_t i = 0; i < column.size(); ++i) {
      shift[i] = i == 0 ? 0.0 : shift[i - 1] + distance(column[i - 1], column[i]);
      pools.push_back({wish[i] - shift[i], items_[column[i]].box == none ? 3.0 : 1.0, 1});
      while (pools.size() > 1 && pools[pools.size() - 2].mean > pools.back().mean) {
        const Pool last = pools.back();
        pools.pop_back();
        Pool& pool = pools.back();
        pool.mean = (pool.mean * pool.weight + last.mean * last.weight) / (pool.weight + last.weight);
        pool.weight += last.weight;
        pool.count += last.count;
      }
    }
    std::size_t i = 0;
    for (const Pool& pool : pools) {
      for (std::size_t k = 0; k < pool.count; ++k, ++i) {
        items_[column[i]].y = pool.mean + shift[i];
      }
    }
  }

  void assign_heights() {
    for (const auto& column : columns_) {
      place(column, std::vector<double>(column.size(), 0.0));
    }
    for (int sweep = 0; sweep < height_sweeps; ++sweep) {
      const bool from_left = sweep % 2 == 0;
      const bool both = sweep >= height_sweeps - 4;
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        const auto& column = columns_[from_left ? i : columns_.size() - 1 - i];
        std::vector<double> wish;
        for (const std::size_t item : column) {
          wish.push_back(wished_height(item, from_left, both));
        }
        place(column, wish);
      }
    }
    double top = 1e300;
    double bottom = -1e300;
    for (const Item& item : items_) {
      top = std::min(top, item.y);
      bottom = std::max(bottom, item.y + item.height);
    }
    for (Item& item : items_) {
      item.y += margin - top;
    }
    bottom_ = items_.empty() ? margin : bottom + margin - top;
  }

  /// The height at which the links of an item on one side run straight.
  [[nodiscard]] double wished_height(std::size_t item, bool from_left, bool both) const {
    double sum = 0.0;
    int count = 0;
    for (const Link& link : links_) {
      if (link.to == item && (from_left || both)) {
        sum += items_[link.from].y + link.from_height - link.to_height;
        ++count;
      }
      if (link.from == item && (!from_left || both)) {
        sum += items_[link.to].y + link.to_height - link.from_height;
        ++count;
      }
    }
    return count == 0 ? items_[item].y : sum / count;
  }

  static void straight(std::vector<Point>& curve, Point to) {
    const Point from = curve.back();
    curve.push_back({from.x + (to.x - from.x) / 3.0, from.y + (to.y - from.y) / 3.0});
    curve.push_back({to.x - (to.x - from.x) / 3.0, to.y - (to.y - from.y) / 3.0});
    curve.push_back(to);
  }
  static void bend(std::vector<Point>& curve, Point to) {
    const Point from = curve.back();
    const double middle = 0.5 * (from.x + to.x);
    curve.push_back({middle, from.y});
    curve.push_back({middle, to.y});
    curve.push_back(to);
  }

  Layout drawn() const {
    std::vector<double> left(columns_.size(), 0.0);
    std::vector<double> right(columns_.size(), 0.0);
    double x = margin;
    for (std::size_t column = 0; column < columns_.size(); ++column) {
      double width = 0.0;
      for (const std::size_t item : columns_[column]) {
        width = std::max(width, items_[item].box == none ? 0.0 : boxes_[items_[item].box].width);
      }
      left[column] = x;
      right[column] = x + width;
      x += width + column_gap;
    }
    Layout layout;
    layout.width = x - column_gap + margin;
    layout.height = bottom_ + margin;
    for (std::size_t box = 0; box < boxes_.size(); ++box) {
      const std::size_t column = column_[box];
      layout.boxes.push_back({0.5 * (left[column] + right[column] - boxes_[box].width), items_[box].y});
    }
    double lane = bottom_ + lane_gap;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const LayoutEdge& edge = edges_[e];
      const Point from{layout.boxes[edge.from].x + boxes_[edge.from].width,
                       layout.boxes[edge.from].y + edge.from_height};
      const Point to{layout.boxes[edge.to].x, layout.boxes[edge.to].y + edge.to_height};
      std::vector<Point> curve{from};
      straight(curve, {right[column_[edge.from]], from.y});
      if (backward_[e]) {
        const double out = right[column_[edge.from]];
        const double in = left[column_[edge.to]];
        curve.push_back({out + turn, from.y});
        curve.push_back({out + turn, lane});
        curve.push_back({out, lane});
        straight(curve, {in, lane});
        curve.push_back({in - turn, lane});
        curve.push_back({in - turn, to.y});
        curve.push_back({in, to.y});
        layout.height = lane + margin;
        layout.width = std::max(layout.width, out + column_gap + margin);
        lane += lane_gap;
      } else {
        for (const std::size_t item : ways_[e]) {
          bend(curve, {left[items_[item].column], items_[item].y});
          straight(curve, {right[items_[item].column], items_[item].y});
        }
        bend(curve, {left[column_[edge.to]], to.y});
      }
      straight(curve, to);
      layout.curves.push_back(std::move(curve));
    }
    return layout;
  }

  const std::vector<LayoutBox>& boxes_;
  const std::vector<LayoutEdge>& edges_;
  std::vector<bool> backward_;
  std::vector<std::size_t> order_{};
  std::vector<std::size_t> column_;
  std::vector<Item> items_{};  ///< the boxes first
  std::vector<Link> links_{};
  std::vector<std::vector<std::size_t>> columns_{};  ///< items from top to bottom
  std::vector<std::vector<std::size_t>> ways_;       ///< by edge: items that it passes
  double bottom_ = 0.0;
};

}  // namespace

Layout layered_layout(const std::vector<LayoutBox>& boxes, const std::vector<LayoutEdge>& edges) {
  return Layering(boxes, edges).run();
}

}  // namespace hysteron::diagnosis::report
