// What exactness_test.cpp evaluates on both sides: the operations that docs call bit-exact, and those that are not.
#ifndef GNOMON_TEST_ARITHMETIC_GLSL
#define GNOMON_TEST_ARITHMETIC_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

struct ArithmeticInput {
  vec3 a;
  vec3 b;
  float x;
  float y;
  float positive;
};

struct ArithmeticOutput {
  float sum;
  float difference;
  float product;
  float quotient;
  float root;
  float inverseRoot;
  float dotProduct;
  vec3 crossProduct;
  float lengthOfA;
  float fraction;
  float whole;
  uint less;
  vec3 unit;
};

GNOMON_FN ArithmeticOutput computeArithmetic(ArithmeticInput i) {
  ArithmeticOutput o;
  o.sum = i.x + i.y;
  o.difference = i.x - i.y;
  o.product = i.x * i.y;
  o.quotient = i.x / i.y;
  o.root = sqrt(i.positive);
  o.inverseRoot = inversesqrt(i.positive);
  o.dotProduct = dot(i.a, i.b);
  o.crossProduct = cross(i.a, i.b);
  o.lengthOfA = length(i.a);
  o.fraction = fract(i.x);
  o.whole = floor(i.x);
  o.less = i.x < i.y ? 1u : 0u;
  o.unit = normalize(i.a);
  return o;
}

struct TranscendentalInput {
  float x;
  float y;
  float cosine;    // in [-1, 1]
  float angle;     // radians
  float exponent;  // in [-8, 8]
  float positive;
};

struct TranscendentalOutput {
  float sine;
  float cosine;
  float arcTangent;
  float arcCosine;
  float exponential;
  float logarithm;
  float power;
};

GNOMON_FN TranscendentalOutput computeTranscendentals(TranscendentalInput i) {
  TranscendentalOutput o;
  o.sine = sin(i.angle);
  o.cosine = cos(i.angle);
  o.arcTangent = atan2(i.y, i.x);
  o.arcCosine = acos(i.cosine);
  o.exponential = exp(i.exponent);
  o.logarithm = log(i.positive);
  o.power = pow(i.positive, i.exponent);
  return o;
}

GNOMON_SHARED_END
#endif
