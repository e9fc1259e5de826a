// The joint of examples/joint/study.toml: V = k W, normal scatter, k > 0 flat, sigma ~ U(0, 15 mm^3).
// k in 1e-4 mm^3/(N m), so that Stan starts on a unit scale.
data {
  int<lower=1> n;
  vector[n] work;
  vector[n] volume;
}
parameters {
  real<lower=0> k;
  real<lower=0, upper=15> sigma;
}
model {
  volume ~ normal(1e-4 * k * work, sigma);
}
