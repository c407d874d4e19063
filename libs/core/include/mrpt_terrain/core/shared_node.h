// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

namespace mrpt_terrain {

/// Base of what several snapshots may hold at once; counts its holders.
class SharedNode {
 public:
  SharedNode() = default;
  SharedNode(const SharedNode&) = delete;
  SharedNode& operator=(const SharedNode&) = delete;
  virtual ~SharedNode() = default;

 private:
  template <class T>
  friend class Ref;
  mutable std::atomic<std::uint32_t> holders_{0};
};

/// Handle of a `SharedNode`: the last one to go deletes it. Handles may be copied and dropped in
/// any thread; what they lead to may be changed only by somebody who is its only holder.
template <class T>
class Ref {
 public:
  Ref() = default;
  explicit Ref(T* node) : node_(node) { hold(); }
  Ref(const Ref& other) : node_(other.node_) { hold(); }
  Ref(Ref&& other) noexcept : node_(std::exchange(other.node_, nullptr)) {}
  Ref& operator=(Ref other) noexcept {
    std::swap(node_, other.node_);
    return *this;
  }
  ~Ref() { drop(); }

  [[nodiscard]] T* get() const { return node_; }
  T& operator*() const { return *node_; }
  T* operator->() const { return node_; }
  explicit operator bool() const { return node_ != nullptr; }

  /// Whether this is the only handle: then all that others did with the node has happened before.
  [[nodiscard]] bool is_only_one() const {
    return node_->SharedNode::holders_.load(std::memory_order_acquire) == 1;
  }

 private:
  void hold() const {
    if (node_ != nullptr) node_->SharedNode::holders_.fetch_add(1, std::memory_order_relaxed);
  }
  void drop() const {
    if (node_ == nullptr) return;
    if (node_->SharedNode::holders_.fetch_sub(1, std::memory_order_acq_rel) == 1) delete node_;
  }

  T* node_ = nullptr;
};

}  // namespace mrpt_terrain
