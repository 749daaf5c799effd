//! E\[n_k\] = nu_k, for every strategy, every rounding and populations of every kind.

use super::*;

/// Resamples `particles` many times and compares the mean of every count with its nu.
fn assert_means(strategy: &dyn Strategy, particles: &Particles, draws: u32) {
    let mut random = random(20);
    let mut offspring = Offspring::new();
    let mut observed = vec![Moments::default(); particles.importance.len()];
    for _ in 0..draws {
        strategy.resample(&particles.population(0), &mut random, &mut offspring);
        for (observed, n) in observed.iter_mut().zip(counts(&offspring)) {
            observed.add(n as f64);
        }
    }
    for (k, (observed, nu)) in observed.iter().zip(means(&offspring)).enumerate() {
        // Where children are rare and none was seen, the least variance that an integer can have.
        let variance = observed.variance().max(nu.fract() * (1.0 - nu.fract()));
        let tolerance = 5.0 * (variance / f64::from(draws)).sqrt() + 2.0 / f64::from(draws);
        assert!(
            (observed.mean() - nu).abs() <= tolerance,
            "{strategy:?}, particle {k}: mean {} +- {tolerance}, nu {nu}",
            observed.mean()
        );
    }
}

#[test]
fn ordinary_populations() {
    let mut particles = Particles::default();
    let mut numbers = random(3);
    for group in [0, 0, 0, 0, 0, 0, 0, 3, 4, 4, 4, 4, 9, 9] {
        let [w, a] = numbers.uniform_2d();
        particles.push(2.0 * w, a, 10.0 * numbers.uniform(), group);
    }
    particles.importance[2] = 0.0;
    particles.albedo[9] = 0.0;
    for strategy in every_strategy() {
        assert_means(strategy.as_ref(), &particles, 40_000);
    }
}

#[test]
fn hostile_populations() {
    const DENORMAL: f32 = 1e-40;
    let populations = [
        Particles::white(&[]),
        Particles::white(&[0.7]),
        Particles::white(&[0.0; 5]),
        Particles::white(&[0.0, 0.0, 2.6, 0.0]),
        Particles::white(&[1e-30, 0.4, 1e30, 0.0, 0.4]),
        Particles::white(&[DENORMAL, 0.3, DENORMAL, 0.0, DENORMAL]),
        Particles::white(&[1.0; 7]),
        Particles::white(&[0.001; 100]),
    ];
    for strategy in every_strategy() {
        for particles in &populations {
            assert_means(strategy.as_ref(), particles, 4_000);
        }
    }
}

/// The whole of a large population lands on its single particles as it should: every hundredth of it gets its share.
#[test]
fn large_populations() {
    const SIZE: usize = 1 << 20;
    let mut numbers = random(4);
    let importance: Vec<f32> = (0..SIZE).map(|_| numbers.uniform()).collect();
    let particles = Particles::white(&importance);
    let mut offspring = Offspring::new();
    for rounding in Rounding::ALL {
        filter(rounding).resample(&particles.population(0), &mut numbers, &mut offspring);
        for (n, nu) in counts(&offspring)
            .chunks(SIZE / 100)
            .zip(means(&offspring).chunks(SIZE / 100))
        {
            let n = n.iter().sum::<u64>() as f64;
            let nu: f64 = nu.iter().sum();
            // No rounding has more variance than the Poisson distribution.
            assert!(
                (n - nu).abs() < 5.0 * nu.sqrt(),
                "{rounding}: {n} children, {nu} expected"
            );
        }
    }
}

/// Counts of different groups are uncorrelated, and a group draws the same whatever stands behind it.
#[test]
fn groups_do_not_influence_each_other() {
    let mut particles = Particles::white(&[0.5, 0.3, 0.5, 0.3, 0.7, 0.9]);
    particles.group = vec![0, 0, 1, 1, 1, 1];
    let mut alone = particles.clone();
    for column in [
        &mut alone.importance,
        &mut alone.albedo,
        &mut alone.shininess,
    ] {
        column.truncate(2);
    }
    alone.group.truncate(2);

    for rounding in Rounding::ALL {
        let strategy = filter(rounding);
        let (mut random, mut offspring) = (random(5), Offspring::new());
        let mut product = Moments::default();
        for _ in 0..40_000 {
            strategy.resample(&particles.population(0), &mut random, &mut offspring);
            let n = counts(&offspring);
            product.add((n[0] as f64 - 0.5) * (n[2] as f64 - 0.5));
        }
        assert!(
            product.mean().abs() < 5.0 * product.standard_error(),
            "{rounding}: {product:?}"
        );

        for seed in 0..100 {
            let (mut one, mut other) = (Offspring::new(), Offspring::new());
            strategy.resample(&particles.population(0), &mut super::random(seed), &mut one);
            strategy.resample(&alone.population(0), &mut super::random(seed), &mut other);
            let of_first_group = one
                .children()
                .iter()
                .take_while(|child| child.parent < 2)
                .count();
            assert_eq!(
                &one.children()[..of_first_group],
                other.children(),
                "{rounding}"
            );
        }
    }
}
