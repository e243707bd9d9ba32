#pragma once
// What Dou et al. 2014 print and do not mean, and the constant bias in their units: biases of one's own
// (shadow/user_bias.h), embedded from src/lab/paper/errata/.

namespace gnomon {

extern const char* const kErrataConstantInDepthGlsl;
extern const char* const kErrataEquation6Glsl;
extern const char* const kErrataRayAlongAxisGlsl;
extern const char* const kErrataRayOfLongNormalGlsl;
extern const char* const kErrataRayNotUnitGlsl;

}  // namespace gnomon
