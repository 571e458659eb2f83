"""What a pair bears: permissible stresses, safeties and life by ISO 6336-2, -3 and -6."""
