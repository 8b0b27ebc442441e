// Log-luminance histogram: 256 bins of a sixth of a stop, integer counts, hence the same sum in any order.
const float FirstStop = -24.0;
const float BinsPerStop = 6.0;
uint luminance_bin(float value) {
  return uint(clamp((log2(max(value, 1e-12)) - FirstStop) * BinsPerStop, 0.0, 255.0));
}
float bin_stop(uint bin) { return FirstStop + (float(bin) + 0.5) / BinsPerStop; }
