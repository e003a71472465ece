#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lpf {

/// Points that are added one by one and searched within a fixed reach. Cells are two reaches wide,
/// so that a ball meets at most eight of them; only cells with points exist. Distances decide, so
/// two cells with equal hashes cost time but change nothing.
class HashGrid {
public:
    /// @param low   corner below all points  @param extent largest side of their box
    /// @param reach radius of every search [input length], > 0
    HashGrid(const Eigen::Vector3d& low, double extent, double reach)
        : squared_reach_(reach * reach),
          low_(low),
          cell_size_(std::max(2.001 * reach, extent * 0x1p-30)),
          slots_(1U << 10U, kEmpty) {}

    /// @returns the number of the point: 0, 1, 2, ...
    std::uint32_t add(const Eigen::Vector3d& point) {
        if (2 * used_slots_ >= slots_.size()) grow();
        const std::uint64_t key = hash(cell_of(point));
        std::uint32_t& head = slots_[slot_of(key)];
        used_slots_ += head == kEmpty;
        items_.push_back({point, key, head});
        return head = static_cast<std::uint32_t>(items_.size() - 1);
    }

    /// Calls visit(number, point) for the points within reach (inclusive), until it returns false.
    template <typename Visit>
    void for_each_near(const Eigen::Vector3d& at, Visit visit) const {
        const Eigen::Vector3d position = (at - low_) / cell_size_;
        const Cell cell = cell_of(at);
        Cell towards;  // to the nearer neighbour along each axis
        for (int c = 0; c < 3; ++c) {
            towards[c] = position[c] - static_cast<double>(cell[c]) < 0.5 ? -1 : 1;
        }
        for (int corner = 0; corner < 8; ++corner) {
            const Cell step(corner & 1, (corner >> 1) & 1, corner >> 2);
            const std::uint64_t key = hash(cell + step.cwiseProduct(towards));
            for (std::uint32_t i = slots_[slot_of(key)]; i != kEmpty; i = items_[i].next) {
                if ((items_[i].point - at).squaredNorm() > squared_reach_) continue;
                if (!visit(i, items_[i].point)) return;
            }
        }
    }

private:
    using Cell = Eigen::Matrix<std::int64_t, 3, 1>;
    static constexpr std::uint32_t kEmpty = 0xffffffff;

    struct Item {
        Eigen::Vector3d point;
        std::uint64_t key;
        std::uint32_t next;  // item of the same key
    };

    [[nodiscard]] Cell cell_of(const Eigen::Vector3d& point) const {
        return ((point - low_) / cell_size_).array().floor().cast<std::int64_t>();
    }

    static std::uint64_t hash(const Cell& cell) {
        std::uint64_t key = 0;
        for (int c = 0; c < 3; ++c) {
            key = (key ^ static_cast<std::uint64_t>(cell[c])) * 0x9e3779b97f4a7c15ULL;
            key ^= key >> 32U;
        }
        return key;
    }

    /// The slot that holds the key, or the empty one where it belongs.
    [[nodiscard]] std::size_t slot_of(std::uint64_t key) const {
        std::size_t slot = key & (slots_.size() - 1);
        while (slots_[slot] != kEmpty && items_[slots_[slot]].key != key) {
            slot = (slot + 1) & (slots_.size() - 1);
        }
        return slot;
    }

    void grow() {
        const std::vector<std::uint32_t> old = std::move(slots_);
        slots_.assign(2 * old.size(), kEmpty);
        for (const std::uint32_t head : old) {
            if (head != kEmpty) slots_[slot_of(items_[head].key)] = head;
        }
    }

    double squared_reach_;
    Eigen::Vector3d low_;
    double cell_size_;
    std::vector<Item> items_;
    std::vector<std::uint32_t> slots_;  // open addressing; first item of a key
    std::size_t used_slots_ = 0;
};

}  // namespace lpf
