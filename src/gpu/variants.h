#pragma once
// Programs by what they are specialized for.

#include <deque>

namespace gnomon::gpu {

// One program a key, made when it is first asked for. References stay good.
template <class Key, class Program>
class Variants {
 public:
  // make(key) is called for a key that is new; nothing is kept if it throws.
  template <class Make>
  const Program& get(const Key& key, const Make& make) {
    for (const Variant& variant : variants_)
      if (variant.key == key) return variant.program;
    return variants_.emplace_back(Variant{key, make(key)}).program;
  }

 private:
  struct Variant {
    Key key;
    Program program;
  };
  std::deque<Variant> variants_;
};

}  // namespace gnomon::gpu
