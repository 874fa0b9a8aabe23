pub fn score(_: &[String]) -> Result<(), Box<dyn std::error::Error>> {
    Ok(())
}
