"""What the report judges and answers: verdict, checks, comparison, origins, end."""
