use clap::Args;
/// temp
#[derive(Args)]
pub struct ModelsArgs {}
pub fn run(_a: ModelsArgs) -> Result<(), std::io::Error> {
    Ok(())
}
