//! What accuracy costs in time: competitors at equal budgets, their errors, and how sure that is.

mod flip;
pub mod measures;
pub mod pairs;
pub mod reference;
pub mod results;
pub mod statistics;
#[cfg(test)]
mod synthetic;
#[cfg(test)]
mod tests;
