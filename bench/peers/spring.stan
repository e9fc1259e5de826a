// Case 2 of examples/spring: Basquin with Goodman's mean stress, log10 life normal, uniform priors. Stresses in MPa, lives in 1e5.
data {
  int<lower=1> n;
  vector[n] mean_stress;
  vector[n] alternating_stress;
  vector[n] log10_life;
}
parameters {
  real<lower=2, upper=4> log10_a;
  real<lower=-0.1, upper=-0.06> b;
  real<lower=3.1, upper=5.2> log10_Sut;
  real<lower=0.01, upper=0.6> sigma;
}
model {
  vector[n] log10_reversed = log(alternating_stress ./ (1 - mean_stress * 10^(-log10_Sut))) / log(10.0);
  log10_life ~ normal((log10_reversed - log10_a) / b, sigma);
}
