// One instance a view: which view an instance of a caster is.

/// The n-th view of the group that sees the caster. There is one: selection has counted them.
uint nth_view(uint caster, uint n) {
  if (!each_view) return push.first_view + n;
  uint end = push.first_view + push.view_count;
  for (uint word = push.first_view / 32u; 32u * word < end; ++word) {
    uint low = max(push.first_view, 32u * word) - 32u * word;
    uint high = min(end, 32u * (word + 1u)) - 32u * word;
    uint bits = bitfieldExtract(Uints(push.visible).v[caster * ViewWords + word], int(low), int(high - low)) << low;
    uint count = uint(bitCount(bits));
    if (n >= count) {
      n -= count;
      continue;
    }
    if (count == high - low) return 32u * word + low + n;
    for (; n > 0u; --n) bits &= bits - 1u;
    return 32u * word + uint(findLSB(bits));
  }
  return push.first_view;
}
